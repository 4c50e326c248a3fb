"""Headless Chromium for tests, driven over WebDriver by the standard library alone (Debian's
chromium-driver)."""
import base64
import json
import shutil
import socket
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

NEEDED = "tests of pages need Debian's chromium and chromium-driver (scripts/prepare.sh)"
# whatever the proxies of this machine are
LOCAL = urllib.request.build_opener(urllib.request.ProxyHandler({}))
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"


class Browser:
    def __init__(self, width=1280, height=900, dark=False, network=False, webgl=True):
        """network: requests() can be asked."""
        program = shutil.which("chromedriver")
        if program is None or shutil.which("chromium") is None:
            raise AssertionError(NEEDED)
        self.folder = tempfile.TemporaryDirectory(prefix="mortier-browser-")
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.process = subprocess.Popen([program, f"--port={port}"], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        self.address = f"http://127.0.0.1:{port}/session"
        options = ["--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--disable-gpu",
                   "--enable-unsafe-swiftshader" if webgl else "--disable-3d-apis",
                   "--disable-dev-shm-usage", "--hide-scrollbars",
                   "--force-device-scale-factor=1", f"--user-data-dir={self.folder.name}",
                   f"--window-size={width},{height}", *(["--force-dark-mode"] if dark else [])]
        logs = {"browser": "ALL", **({"performance": "ALL"} if network else {})}
        capabilities = {"alwaysMatch": {"browserName": "chrome", "goog:loggingPrefs": logs,
                                        "goog:chromeOptions": {"args": options}}}
        for _ in range(100):
            try:
                self.session = self.send("POST", "", {"capabilities": capabilities})["sessionId"]
                break
            except (urllib.error.URLError, ConnectionError) as error:
                if isinstance(error, urllib.error.HTTPError):
                    raise AssertionError(error.read().decode()) from error
                time.sleep(0.1)
        self.address += f"/{self.session}"
        self.cdp("Emulation.setEmulatedMedia",
                 features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.size(width, height)

    def send(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.address + path, data, {"Content-Type": "application/json"},
                                         method=method)
        with LOCAL.open(request, timeout=120) as answer:
            return json.loads(answer.read())["value"]

    def cdp(self, command, **parameters):
        return self.send("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def size(self, width, height):
        self.cdp("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                 mobile=width < 600)

    def open(self, path):
        """Opens a page of mortier report and waits until it can be used;
        milliseconds from navigation to that."""
        self.send("POST", "/url", {"url": path.resolve().as_uri()})
        for _ in range(600):
            if ready := self.run("return document.documentElement.dataset.ready"):
                return float(ready)
            time.sleep(0.05)
        raise AssertionError(f"{path}: not ready after 30 s: {self.messages()}")

    def run(self, script, *arguments):
        """The value that a function body of JavaScript returns, a promise's too."""
        return self.send("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def run_async(self, script):
        """The same of a body that awaits."""
        return self.run(f"return (async () => {{{script}}})()")

    def messages(self):
        """All that stands in the console since the last call."""
        return [entry["message"] for entry in self.send("POST", "/se/log", {"type": "browser"})]

    def requests(self, page):
        """The addresses that a page has asked for since the last call; not those of the browser's
        own pages, which come when they come."""
        entries = [json.loads(entry["message"])["message"]
                   for entry in self.send("POST", "/se/log", {"type": "performance"})]
        return [entry["params"]["request"]["url"] for entry in entries
                if entry["method"] == "Network.requestWillBeSent"
                and entry["params"]["documentURL"].split("#")[0] == page.resolve().as_uri()]

    def element(self, selector):
        return self.send("POST", "/element", {"using": "css selector", "value": selector})[ELEMENT]

    def press(self, selector, keys):
        """Keys for an element, as a keyboard sends them."""
        self.send("POST", f"/element/{self.element(selector)}/value", {"text": keys})

    def point(self, x, y):
        """Moves the mouse to a place of the window."""
        move = {"type": "pointerMove", "duration": 0, "x": round(x), "y": round(y)}
        self.send("POST", "/actions",
                  {"actions": [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
                                                    "actions": [move]}]})

    def picture(self):
        return base64.b64decode(self.send("GET", "/screenshot"))

    def close(self):
        try:
            self.send("DELETE", "")
        except (OSError, ValueError):
            pass
        self.process.terminate()
        self.process.wait(10)
        self.folder.cleanup()

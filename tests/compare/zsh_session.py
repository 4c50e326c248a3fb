"""An interactive zsh on a terminal of its own, asked what it completes."""
import os
import pty
import select
import time

SETUP = """\
PS1= PROMPT_EOL_MARK=
fpath=({functions} $fpath)
path=({programs} $path)
autoload -U compinit; compinit -D -u
compadd() {{  # what is offered goes to a file too
  [[ ${{@[1,(i)(-|--)]}} == *-(O|A|D)\\ * ]] && {{ builtin compadd "$@"; return }}
  local -a offered
  builtin compadd -O offered "$@"
  print -rl -- $offered >> {found}
  builtin compadd "$@"
}}
over() {{ print -- {end} >> {found} }}
zle -N over; bindkey '^T' over
cd {folder}
over
"""
END = "END"


class ZshSession:
    def __init__(self, folder, programs, functions):
        """Works in `folder`; finds programs and completion functions in the other two."""
        self.found = folder / "found.zsh"
        setup = folder / "setup.zsh"
        setup.write_text(SETUP.format(functions=functions, programs=programs, folder=folder, found=self.found,
                                      end=END))
        self.process, self.terminal = pty.fork()
        if self.process == 0:
            os.execvpe("zsh", ["zsh", "-f", "-i"], {**os.environ, "TERM": "dumb"})
        self.answer(f"source {setup}\n")
        self.answer("\x14")  # the line editor answers: before it begins the terminal takes ^U itself

    def close(self):
        os.close(self.terminal)  # hangs up
        os.waitpid(self.process, 0)

    def complete(self, *words):
        """What is offered after these words."""
        return self.answer(" ".join(words) + "\t\x15\x14")

    def answer(self, keys):
        self.found.write_text("")
        os.write(self.terminal, keys.encode())
        deadline = time.monotonic() + 60
        while END not in (offered := self.found.read_text().split()):
            if select.select([self.terminal], [], [], 0.01)[0]:
                os.read(self.terminal, 4096)  # its echo, or it would wait
            assert time.monotonic() < deadline, f"zsh does not answer to {keys!r}: {offered}"
        return sorted(set(offered) - {END})

// ---- Mouse, touch and keys on bodies in the plane ---------------------------------------------------------
function startDrawing() {
  for (const panel of panels) panel.context = panel.canvas.getContext("2d");
}
function zoom(group, factor, x = group.view.x, y = group.view.y) {
  const {view} = group;
  group.view = {...view, half: view.half * factor, x: x + (view.x - x) * factor,
                y: y + (view.y - y) * factor};
  redraw();
}
function move(group, x, y) {
  group.view = {...group.view, x: group.view.x + x, y: group.view.y + y};
  redraw();
}
for (const panel of panels) {
  const {canvas} = panel, {group} = panel.run, down = new Map();
  const length = () => 2 * group.view.half / canvas.clientWidth, point = event => pointIn(canvas, event);
  const place = ([x, y]) =>
      [group.view.x + (x - canvas.clientWidth / 2) * length(),
       group.view.y - (y - canvas.clientHeight / 2) * length()];
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    zoom(group, Math.exp(0.0015 * event.deltaY), ...place(point(event)));
  }, {passive: false});
  canvas.addEventListener("pointerdown", event => {
    down.set(event.pointerId, point(event));
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", event => {
    const to = point(event), from = down.get(event.pointerId);
    panel.last = to;
    if (from && down.size === 2) {
      const other = [...down].find(([id]) => id !== event.pointerId)[1],
            distance = p => Math.hypot(p[0] - other[0], p[1] - other[1]);
      if (distance(to) > 0) zoom(group, distance(from) / distance(to), ...place(other));
    } else if (from) {
      move(group, (from[0] - to[0]) * length(), (to[1] - from[1]) * length());
    } else hover(panel, ...to);
    if (from) down.set(event.pointerId, to);
  });
  for (const name of ["pointerup", "pointercancel"])
    canvas.addEventListener(name, event => {
      down.delete(event.pointerId);
      hover(panel, ...(panel.last = point(event)));
    });
  canvas.addEventListener("pointerleave", () => {
    if (!down.size) {
      panel.last = null;
      hover(panel, -1, -1);
    }
  });
  canvas.addEventListener("dblclick", () => showAll(group));
  canvas.addEventListener("keydown", event => {
    const step = 0.1 * group.view.half, way = WAYS[event.key];
    if (way) move(group, step * way[0], step * way[1]);
    else if ("+=-".includes(event.key)) zoom(group, event.key === "-" ? 1.25 : 0.8);
    else if (event.key === "0") showAll(group);
    else return;
    event.preventDefault();
  });
}

// ---- Colours ----------------------------------------------------------------------------------------------
const tables = Object.fromEntries(Object.entries(data.colours).map(([name, stops]) => {
  const rgb = stops.map(stop => [0, 2, 4].map(i => parseInt(stop.slice(i, i + 2), 16)));
  return [name, Uint32Array.from({length: 256}, (_, i) => {
    const at = i / 255 * (rgb.length - 1), k = Math.min(Math.floor(at), rgb.length - 2), f = at - k;
    const [red, green, blue] = rgb[k].map((each, c) => Math.round(each + f * (rgb[k + 1][c] - each)));
    return (255 << 24 | blue << 16 | green << 8 | red) >>> 0;
  })];
}));
function colourRange({runs}) {  // one for all runs of a group; a corner must not take all the colours
  const signed = fieldOf(runs[0], now.field).signed;
  const found = runs.flatMap(
      run => (now.wide ? run.ranges : [run.ranges[stepOf(run)]]).map(each => each[now.field]));
  let low = Math.min(...found.map(each => each[0])), high = Math.max(...found.map(each => each[1])),
      cut = false;
  const top = Math.max(...found.map(each => each[2])), size = Math.max(Math.abs(low), Math.abs(high));
  if (signed) { cut = top < 0.7 * size && top > 0; high = cut ? top : size; low = -high; }
  else {
    cut = top < 0.7 * high && top > 0;
    if (cut) high = top;
    if (high - low > 0.5 * Math.abs(high)) low = Math.min(0, low);
  }
  if (!(high - low > 1e-9 * size)) { const margin = 0.1 * size || 1; low -= margin; high += margin; }
  return {low, high, cut, largest: size, table: tables[signed ? "signed" : "plain"], signed};
}

// ---- Bodies: triangles are painted pixel by pixel, and each pixel knows its triangle ----------------------
// Runs with bodies of the same names are seen alike: one part of the plane, its centre and half width, and
// one scale of colours.
const groups = new Map();
for (const run of runs) {
  const names = run.bodies.map(body => body.name).join();
  if (!groups.has(names)) groups.set(names, {runs: [], view: null, fit: true});  // fit: everything, next time
  groups.get(names).runs.push(run);
  run.group = groups.get(names);
}
function everything({runs}) {
  let box = [Infinity, -Infinity, Infinity, -Infinity];
  for (const run of runs) run.bodies.forEach((body, b) => {
    const fields = run.steps[stepOf(run)].fields[b];
    for (let v = 0; v < body.vertices; v++) for (const s of [0, now.scale]) {
        const x = body.x[v] + s * scaled(fields.ux.q[v], fields.ux.e),
              y = body.y[v] + s * scaled(fields.uy.q[v], fields.uy.e);
        if (x < box[0]) box[0] = x;
        if (x > box[1]) box[1] = x;
        if (y < box[2]) box[2] = y;
        if (y > box[3]) box[3] = y;
    }
  });
  const width = Math.max(box[1] - box[0], 1e-300), height = Math.max(box[3] - box[2], 1e-300);
  const seen = panels[0].canvas.clientWidth || 1;
  const aspect = Math.min(
      Math.max(height / width, 0.5), 1.25, Math.max(0.5, 0.72 * window.innerHeight / seen));
  return {
    x: (box[0] + box[1]) / 2,
    y: (box[2] + box[3]) / 2,
    half: 0.53 * Math.max(width, height / aspect),
    aspect
  };
}
function paint(panel, range) {
  const {run, canvas, context} = panel, {view} = run.group, ratio = Math.min(window.devicePixelRatio || 1, 2);
  const w = Math.max(1, Math.round(canvas.clientWidth * ratio)), h = Math.max(1, Math.round(w * view.aspect));
  if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
  const image = context.createImageData(w, h), pixels = new Uint32Array(image.data.buffer);
  const owner = panel.owner && panel.owner.length === w * h ? panel.owner.fill(-1)
                                                            : new Int32Array(w * h).fill(-1);
  const perLength = w / (2 * view.half), X = x => (x - view.x) * perLength + w / 2,
        Y = y => h / 2 - (y - view.y) * perLength;
  const step = stepOf(run), byVertex = fieldOf(run, now.field).vertex, lines = [], offsets = [];
  const colour = value => range.table[Math.max(
      0, Math.min(255, Math.floor((value - range.low) / (range.high - range.low) * 256)))];
  let first = 0;
  run.bodies.forEach((body, b) => {
    const fields = run.steps[step].fields[b], {corners, vertices, triangles} = body,
          px = new Float64Array(vertices), py = new Float64Array(vertices);
    for (let v = 0; v < vertices; v++) {
      px[v] = X(body.x[v] + now.scale * scaled(fields.ux.q[v], fields.ux.e));
      py[v] = Y(body.y[v] + now.scale * scaled(fields.uy.q[v], fields.uy.e));
    }
    const values = now.field === "u"
        ? real(fields.ux).map((x, v) => Math.hypot(x, scaled(fields.uy.q[v], fields.uy.e)))
        : real(fields[now.field]);
    let seen = 0, area = 0;
    for (let t = 0; t < triangles; t++) {
      const i = corners[3 * t], j = corners[3 * t + 1], k = corners[3 * t + 2];
      const ax = px[i], ay = py[i], bx = px[j], by = py[j], cx = px[k], cy = py[k];
      const top = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5)),
            end = Math.min(h - 1, Math.ceil(Math.max(ay, by, cy) - 0.5) - 1);
      if (Math.max(ax, bx, cx) < 0 || Math.min(ax, bx, cx) > w || Math.max(ay, by, cy) < 0 ||
          Math.min(ay, by, cy) > h)
        continue;
      const det = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
      seen++;
      area += Math.abs(det) / 2;
      const flat = byVertex ? 0 : colour(values[t]);
      const gx = byVertex ? ((values[j] - values[i]) * (cy - ay) - (values[k] - values[i]) * (by - ay)) / det
                          : 0;
      const gy = byVertex ? ((values[k] - values[i]) * (bx - ax) - (values[j] - values[i]) * (cx - ax)) / det
                          : 0;
      for (let y = top; y <= end; y++) {
        const at = y + 0.5;
        let left = Infinity, right = -Infinity;
        for (let s = 0; s < 3; s++) {  // an edge cuts the row in the same place for both its triangles
          const ux = s === 0 ? ax : s === 1 ? bx : cx, uy = s === 0 ? ay : s === 1 ? by : cy;
          const vx = s === 0 ? bx : s === 1 ? cx : ax, vy = s === 0 ? by : s === 1 ? cy : ay;
          if ((uy <= at) === (vy <= at)) continue;
          const x = uy < vy ? ux + (at - uy) * (vx - ux) / (vy - uy) : vx + (at - vy) * (ux - vx) / (uy - vy);
          if (x < left) left = x;
          if (x > right) right = x;
        }
        const from = Math.max(0, Math.ceil(left - 0.5)), to = Math.min(w - 1, Math.ceil(right - 0.5) - 1),
              row = y * w;
        for (let x = from; x <= to; x++) {
          pixels[row + x] = byVertex ? colour(values[i] + gx * (x + 0.5 - ax) + gy * (at - ay)) : flat;
          owner[row + x] = first + t;
        }
      }
    }
    lines.push({body, px, py, edges: now.mesh && seen && Math.sqrt(area / seen) > 5 * ratio});
    offsets.push(first);
    first += triangles;
  });
  context.putImageData(image, 0, 0);
  const ink = getComputedStyle(document.body).color;
  for (const {body, px, py, edges} of lines) {
    if (edges) {
      context.beginPath();
      for (let t = 0; t < body.triangles; t++) {
        const [i, j, k] = [body.corners[3 * t], body.corners[3 * t + 1], body.corners[3 * t + 2]];
        if (Math.max(px[i], px[j], px[k]) < 0 || Math.min(px[i], px[j], px[k]) > w ||
            Math.max(py[i], py[j], py[k]) < 0 || Math.min(py[i], py[j], py[k]) > h)
          continue;
        context.moveTo(px[i], py[i]);
        context.lineTo(px[j], py[j]);
        context.lineTo(px[k], py[k]);
        context.closePath();
      }
      context.strokeStyle = "rgba(60,60,66,.35)"; context.lineWidth = 0.5 * ratio; context.stroke();
    }
    const outline = (x, y, dash, width, style) => {
      context.beginPath();
      body.from.forEach((v, i) => {
        context.moveTo(x(v), y(v));
        context.lineTo(x(body.to[i]), y(body.to[i]));
      });
      context.setLineDash(dash);
      context.strokeStyle = style;
      context.lineWidth = width;
      context.stroke();
      context.setLineDash([]);
    };
    if (now.ghost)
      outline(v => X(body.x[v]), v => Y(body.y[v]), [4 * ratio, 4 * ratio], 0.8 * ratio, "#8a8a92");
    outline(v => px[v], v => py[v], [], 0.9 * ratio, ink);
  }
  canvas.dataset.view = [view.x, view.y, view.half];
  Object.assign(
      panel, {owner, offsets, step, px: lines.map(each => each.px), py: lines.map(each => each.py), ratio});
  const strip = panel.bar.getContext("2d"), shades = strip.createImageData(256, 1);
  new Uint32Array(shades.data.buffer).set(range.table);
  strip.putImageData(shades, 0, 0);
  const shownField = fieldOf(run, now.field);
  panel.legend.textContent = withUnit(shownField.words, shownField.unit);
  const marks = ticks(range.low, range.high, 5);
  panel.scale.replaceChildren(...marks.map((value, i) => {
    const part = 100 * (value - range.low) / (range.high - range.low), mark = $("span"),
          last = i === marks.length - 1, first = i === 0 && range.signed,
          beyond = range.cut && (last ? " \u2192" : first ? "\u2190 " : ""),
          words = short(value, 5);
    mark.textContent = !beyond ? words : i ? words + beyond : beyond + words;
    mark.style.left = `${part}%`;
    mark.style.transform = `translateX(${part < 8 ? 0 : part > 92 ? -100 : -50}%)`;
    return mark;
  }));
  panel.scale.title = range.cut ? `largest: ${short(range.largest, 5)}` : "";
}
function hover(panel, x, y) {  // in CSS pixels of the canvas
  const {run, canvas, owner, ratio} = panel, i = Math.floor(x * ratio), j = Math.floor(y * ratio);
  const found = owner && i >= 0 && i < canvas.width && j >= 0 && j < canvas.height
      ? owner[j * canvas.width + i]
      : -1;
  if (found < 0) {
    panel.read.textContent = "Point at a triangle for its values; drag, wheel or keys move and zoom.";
    delete panel.read.dataset.triangle;
    return;
  }
  let b = run.bodies.length - 1;
  while (panel.offsets[b] > found) b--;
  const t = found - panel.offsets[b], body = run.bodies[b], fields = run.steps[panel.step].fields[b],
        field = fieldOf(run, now.field);
  const near = [0, 1, 2]
                   .map(c => body.corners[3 * t + c])
                   .reduce(
                       (best, v) => Math.hypot(panel.px[b][v] - i, panel.py[b][v] - j) <
                               Math.hypot(panel.px[b][best] - i, panel.py[b][best] - j)
                           ? v
                           : best);
  const value = valueOf(fields, now.field, field.vertex ? near : t);
  const say = (name, at) => `${name} ${of(valueOf(fields, name, at), fieldOf(run, name).unit)}`;
  const more = run.order.filter(name => /^s\d/.test(name)).map(name => say(name, t)).join(", ");
  panel.read.textContent = `${field.words} ${of(value, field.unit)} at ${body.name}, ` +
      `${field.vertex ? `vertex ${near}, ` : ""}triangle ${t}: ${more}; ${say("ux", near)}, ${
                               say("uy", near)} at vertex ${near}; ` +
      `estimated error ${valueOf(fields, "error", t)}`;
  Object.assign(panel.read.dataset, {body: body.name, triangle: t, vertex: near, value});
}

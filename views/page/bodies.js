// ---- Bodies in the plane: triangles are painted pixel by pixel, and each pixel knows its triangle ---------
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
      Math.max(height / width, 0.4), 1.25, Math.max(0.4, 0.72 * window.innerHeight / seen));
  return {
    x: (box[0] + box[1]) / 2,
    y: (box[2] + box[3]) / 2,
    half: 0.53 * Math.max(width, height / aspect),
    aspect
  };
}
const CURVED = 0.3;  // pixels of a side off its chord, from which on it is drawn as a curve
const PIECES = 6;    // of a side of a triangle with a curved side
function paint(panel, range) {
  const {run, canvas, context} = panel, {view} = run.group, ratio = Math.min(window.devicePixelRatio || 1, 2);
  const w = Math.max(1, Math.round(canvas.clientWidth * ratio)), h = Math.max(1, Math.round(w * view.aspect));
  if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
  const image = context.createImageData(w, h), pixels = new Uint32Array(image.data.buffer);
  const owner = panel.owner && panel.owner.length === w * h ? panel.owner.fill(-1)
                                                            : new Int32Array(w * h).fill(-1);
  const perLength = w / (2 * view.half), X = x => (x - view.x) * perLength + w / 2,
        Y = y => h / 2 - (y - view.y) * perLength;
  const step = stepOf(run), lines = [], offsets = [], perValue = SHADES / (range.high - range.low);
  const key = [step, now.field, now.raw].join();
  if (panel.key !== key) {
    panel.key = key;
    panel.shown = run.bodies.map((_, b) => shownValues(run, step, b));
    panel.extremes = extremes(panel.shown.map(({flat, corner}) => flat || corner));
  }
  let rigid = false;  // tools have no stress
  const colour = value => rigid ? 0xff9c9c9c : range.table[Math.max(
      0, Math.min(SHADES - 1, Math.floor((value - range.low) * perValue)))];
  // a triangle in pixels; values at its corners, or one
  const fill = (ax, ay, bx, by, cx, cy, number, va, vb, vc) => {
    const top = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5)),
          end = Math.min(h - 1, Math.ceil(Math.max(ay, by, cy) - 0.5) - 1);
    const flat = vb === undefined ? colour(va) : 0, det = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
    const gx = flat ? 0 : ((vb - va) * (cy - ay) - (vc - va) * (by - ay)) / det;
    const gy = flat ? 0 : ((vc - va) * (bx - ax) - (vb - va) * (cx - ax)) / det;
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
        pixels[row + x] = flat || colour(va + gx * (x + 0.5 - ax) + gy * (at - ay));
        owner[row + x] = number;
      }
    }
  };
  let first = 0;
  run.bodies.forEach((body, b) => {
    rigid = body.rigid;
    const fields = run.steps[step].fields[b], {corners, vertices, triangles} = body,
          {flat, corner} = panel.shown[b], px = new Float64Array(vertices), py = new Float64Array(vertices);
    for (let v = 0; v < vertices; v++) {
      px[v] = X(body.x[v] + now.scale * scaled(fields.ux.q[v], fields.ux.e));
      py[v] = Y(body.y[v] + now.scale * scaled(fields.uy.q[v], fields.uy.e));
    }
    const bent = new Map();  // triangle -> its curved sides: corners, and how far the middle is off the chord
    body.from.forEach((from, i) => {
      const to = body.to[i], middle = body.middle[i];
      if (middle === from) return;
      const dx = px[middle] - (px[from] + px[to]) / 2, dy = py[middle] - (py[from] + py[to]) / 2;
      if (Math.hypot(dx, dy) > CURVED * ratio)
        bent.set(body.owner[i], [...(bent.get(body.owner[i]) || []), [from, to, dx, dy]]);
    });
    for (let t = 0; t < triangles; t++) {
      const i = corners[3 * t], j = corners[3 * t + 1], k = corners[3 * t + 2];
      const ax = px[i], ay = py[i], bx = px[j], by = py[j], cx = px[k], cy = py[k];
      if (Math.max(ax, bx, cx) < 0 || Math.min(ax, bx, cx) > w || Math.max(ay, by, cy) < 0 ||
          Math.min(ay, by, cy) > h)
        continue;
      const va = flat ? flat[t] : corner[3 * t], vb = flat ? undefined : corner[3 * t + 1],
            vc = flat ? undefined : corner[3 * t + 2];
      if (!bent.size || !bent.has(t)) { fill(ax, ay, bx, by, cx, cy, first + t, va, vb, vc); continue; }
      const at = (p, q) => {  // of the barycentric grid: place and value
        const r = PIECES - p - q, part = new Map([[i, p / PIECES], [j, q / PIECES], [k, r / PIECES]]);
        let x = (p * ax + q * bx + r * cx) / PIECES, y = (p * ay + q * by + r * cy) / PIECES;
        for (const [from, to, dx, dy] of bent.get(t)) {
          const bubble = 4 * part.get(from) * part.get(to);
          x += bubble * dx;
          y += bubble * dy;
        }
        return [x, y, flat ? va : (p * va + q * vb + r * vc) / PIECES];
      };
      for (let p = 0; p < PIECES; p++) for (let q = 0; p + q < PIECES; q++) {
          const small = [[at(p, q), at(p + 1, q), at(p, q + 1)]];
          if (p + q + 2 <= PIECES) small.push([at(p + 1, q), at(p + 1, q + 1), at(p, q + 1)]);
          for (const [[x1, y1, v1], [x2, y2, v2], [x3, y3, v3]] of small)
            fill(x1, y1, x2, y2, x3, y3, first + t, ...(flat ? [v1] : [v1, v2, v3]));
      }
    }
    lines.push({body, px, py});
    offsets.push(first);
    first += triangles;
  });
  context.putImageData(image, 0, 0);
  const ink = getComputedStyle(document.body).color, least = 80 * ratio * ratio;  // twice the area
  for (const {body, px, py} of lines) {
    const curve = (x, y, i) => {  // through the middle
      const from = body.from[i], to = body.to[i], middle = body.middle[i];
      context.moveTo(x(from), y(from));
      if (middle === from) context.lineTo(x(to), y(to));
      else
        context.quadraticCurveTo(
            2 * x(middle) - (x(from) + x(to)) / 2, 2 * y(middle) - (y(from) + y(to)) / 2, x(to), y(to));
    };
    if (now.mesh) {
      context.beginPath();
      for (let t = 0; t < body.triangles; t++) {  // edges of small ones would darken what is refined
        const [i, j, k] = [body.corners[3 * t], body.corners[3 * t + 1], body.corners[3 * t + 2]];
        if (Math.max(px[i], px[j], px[k]) < 0 || Math.min(px[i], px[j], px[k]) > w ||
            Math.max(py[i], py[j], py[k]) < 0 || Math.min(py[i], py[j], py[k]) > h)
          continue;
        if (Math.abs((px[j] - px[i]) * (py[k] - py[i]) - (px[k] - px[i]) * (py[j] - py[i])) < least) continue;
        context.moveTo(px[i], py[i]);
        context.lineTo(px[j], py[j]);
        context.lineTo(px[k], py[k]);
        context.closePath();
      }
      context.strokeStyle = "rgba(60,60,66,.35)"; context.lineWidth = 0.5 * ratio; context.stroke();
    }
    const outline = (x, y, dash, width, style) => {
      context.beginPath();
      body.from.forEach((_, i) => curve(x, y, i));
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
  markExtremes(panel, range);
  drawLegend(panel, range);
}
function markExtremes(panel, range) {  // where the field is largest, and smallest where it has two signs
  const {run, context, ratio} = panel, style = getComputedStyle(document.body);
  const at = ({b, i}, values) => {
    const {corners} = run.bodies[b];
    if (panel.shown[b].corner) return values[corners[i]];
    return (values[corners[3 * i]] + values[corners[3 * i + 1]] + values[corners[3 * i + 2]]) / 3;
  };
  const place = each => [at(each, run.bodies[each.b].x), at(each, run.bodies[each.b].y)];
  context.font = `${12 * ratio}px system-ui, sans-serif`;
  for (const each of tellExtremes(panel, range, panel.extremes, place)) {
    const x = at(each, panel.px[each.b]), y = at(each, panel.py[each.b]), text = short(each.value, 4);
    context.beginPath();
    context.arc(x, y, 4 * ratio, 0, 2 * Math.PI);
    const right = x + 8 * ratio + context.measureText(text).width < context.canvas.width;
    context.textAlign = right ? "left" : "right";
    const to = [text, x + (right ? 8 : -8) * ratio, Math.max(y - 6 * ratio, 14 * ratio)];
    for (const [width, ink] of [[3 * ratio, style.backgroundColor], [1.4 * ratio, style.color]]) {
      context.lineWidth = width; context.strokeStyle = ink; context.stroke();
    }
    context.lineWidth = 3 * ratio; context.strokeStyle = style.backgroundColor; context.strokeText(...to);
    context.fillStyle = style.color; context.fillText(...to);
  }
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
  const far = v => Math.hypot(panel.px[b][v] - i, panel.py[b][v] - j);
  const corner = [0, 1, 2].reduce(
      (best, c) => far(body.corners[3 * t + c]) < far(body.corners[3 * t + best]) ? c : best);
  const near = body.corners[3 * t + corner], value = valueOf(fields, now.field, field.vertex ? near : t);
  const say = (name, at) => `${name} ${of(valueOf(fields, name, at), fieldOf(run, name).unit)}`;
  const recovered = panel.shown[b].corner && !field.vertex
      ? `; recovered at vertex ${near} ${of(short(panel.shown[b].corner[3 * t + corner], 4), field.unit)}`
      : "";
  const more = run.order.filter(name => /^s\d/.test(name)).map(name => say(name, t)).join(", ");
  panel.read.textContent = `${field.words} ${of(value, field.unit)} at ${body.name}, ` +
      `${field.vertex ? `vertex ${near}, ` : ""}triangle ${t}: ${more}${recovered}; ${say("ux", near)}, ${
                               say("uy", near)} at vertex ${near}; ` +
      `estimated error ${valueOf(fields, "error", t)}`;
  Object.assign(panel.read.dataset, {body: body.name, triangle: t, vertex: near, value});
}

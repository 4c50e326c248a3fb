// The page of mortier report: reads the data that stand in it, draws, answers. Text of the data is shown by textContent only.
"use strict";
(async () => {
const data = JSON.parse(document.getElementById("data").textContent), runs = data.runs;
const $ = (tag, attributes = {}, ...children) => put(document.createElement(tag), attributes, children);
const svg = (tag, attributes = {}, ...children) => put(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
function put(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}
const withUnit = (words, unit) => unit ? `${words} [${unit}]` : words;
const of = (value, unit) => unit ? `${value} ${unit}` : String(value);
const short = (value, digits = 4) => value === 0 ? "0" : String(Number(value.toPrecision(digits)));

// ---- Data (views/coding.py): integers times 10^e, predicted, deflated ------------------------------------------------
const powers = Array.from({length: 309}, (_, e) => Number(`1e${e}`));
const scaled = (q, e) => e >= 0 ? q * powers[e] : q / powers[-e];
async function unpack(text) {
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = letters.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
function arrays(bytes, forms, lengths, earlier, predict) {  // [{e, q}] of a block
  const found = [];
  let at = 0;
  forms.forEach(([e, how, weights], k) => {
    const n = lengths[k], q = new Float64Array(n), plane = n;
    let before = 0;
    for (let w = weights - 1; w >= 0; w--) for (let i = 0; i < n; i++) q[i] = q[i] * 256 + bytes[at + w * plane + i];
    let guess = how === 2 ? predict(found, k, e) : null;
    if (how === 1 || how === 3) {
      guess = new Float64Array(n);
      const add = (steps, factor) => {  // the same array of an earlier step, times 10^e
        const {e: e0, q: old} = earlier[steps - 1][k];
        if (e0 === e) for (let i = 0; i < n; i++) guess[i] += factor * old[i];
        else for (let i = 0; i < n; i++) guess[i] += factor * Math.floor(scaled(old[i], e0 - e) + 0.5);
      };
      if (how === 1) add(1, 1);
      else { add(1, 2); add(2, -1); }
    }
    for (let i = 0; i < n; i++) {
      const folded = q[i], difference = folded % 2 ? -(folded + 1) / 2 : folded / 2;
      before = q[i] = (guess ? guess[i] : before) + difference;
    }
    at += n * weights;
    found.push({e, q});
  });
  return found;
}
function real({e, q}) {
  const values = new Float64Array(q.length);
  for (let i = 0; i < q.length; i++) values[i] = scaled(q[i], e);
  return values;
}
async function loadMesh(body) {
  const {vertices: nv, triangles: nt, edges: ne} = body;
  const a = arrays(await unpack(body.mesh.d), body.mesh.f, [nv, nv, nt, nt, nt, ne, ne, nt]);
  const t = new Int32Array(3 * nt);
  for (let i = 0; i < nt; i++) {
    t[3 * i] = a[2].q[i]; t[3 * i + 1] = a[2].q[i] + a[3].q[i]; t[3 * i + 2] = a[2].q[i] + a[4].q[i];
  }
  Object.assign(body, {x: real(a[0]), y: real(a[1]), corners: t, from: a[5].q, to: a[6].q, region: a[7]});
}
const loadStep = (run, i) => run.steps[i].loaded ??= readStep(run, i);
async function readStep(run, i) {  // body number -> field name -> {e, q}
  const step = run.steps[i];
  const back = Math.max(...step.f.map(form => form[1] === 3 ? 2 : form[1] === 1 ? 1 : 0)), earlier = [];  // steps that it needs
  for (let k = 1; k <= back; k++) { await loadStep(run, i - k); earlier.push(run.steps[i - k].all); }
  const bytes = await unpack(step.d), names = run.order, n = names.length;
  const lengths = run.bodies.flatMap(body => names.map(name => fieldOf(run, name).vertex ? body.vertices : body.triangles));
  const stresses = ["s11", "s22", "s12", "s33"].filter(name => names.includes(name));
  step.all = arrays(bytes, step.f, lengths, earlier, (found, k, e) => {
    const first = k - k % n, s = stresses.map(name => found[first + names.indexOf(name)]);
    const [s11, s22, s12, s33] = s.map(real), guess = new Float64Array(s11.length);
    for (let j = 0; j < guess.length; j++) {
      const a = s11[j], b = s22[j], c = s12[j], d = s33 ? s33[j] : 0;
      guess[j] = Math.floor(scaled(Math.sqrt(Math.max(a * a + b * b - a * b + d * (d - a - b) + 3 * c * c, 0)), -e) + 0.5);
    }
    return guess;
  });
  step.fields = run.bodies.map((body, b) =>
    ({...Object.fromEntries(names.map((name, k) => [name, step.all[b * n + k]])), region: body.region}));
}
const fieldOf = (run, name) => run.fields.find(field => field.name === name);
function valueOf(fields, name, i) {  // a number with the decimals that it has
  if (name === "u") {
    const x = fields.ux, y = fields.uy;
    return Number(Math.hypot(scaled(x.q[i], x.e), scaled(y.q[i], y.e)).toPrecision(4));
  }
  const {e, q} = fields[name];
  return Number(`${q[i]}e${e}`) || 0;
}

// ---- The page --------------------------------------------------------------------------------------------------------
const page = document.getElementById("page"), now = {field: "von_mises", step: 0, scale: 1, wide: true, mesh: true, ghost: true};
const longest = runs.reduce((a, b) => b.steps.length > a.steps.length ? b : a);
const stepOf = run => {  // that of the run nearest in time
  const t = longest.steps[now.step].time;
  let best = 0;
  run.steps.forEach((each, i) => { if (Math.abs(each.time - t) < Math.abs(run.steps[best].time - t)) best = i; });
  return best;
};
page.append($("h1", {}, [...new Set(runs.map(run => run.title))].join(", ")));
for (const run of runs) {
  if (run.failed) page.append($("p", {class: "bad"}, `${run.name} stopped early: ${run.failed}`));
  if (run.steps.length < run.keptSteps)
    page.append($("p", {class: "soft"}, `${run.name}: ${run.steps.length} of ${run.keptSteps} kept steps are in this page.`));
}

function control(words, element, output) {
  controls.append($("label", {}, words, element, ...(output ? [output] : [])));
  return element;
}
const controls = page.appendChild($("div", {class: "controls"}));
const common = runs[0].fields.filter(field => runs.every(run => fieldOf(run, field.name)));
const fieldMenu = control("field", $("select", {id: "field"}, ...common.map(field => $("option", {value: field.name}, withUnit(field.words, field.unit)))));
const stepOutput = $("output", {for: "step"}), scaleOutput = $("output", {for: "scale"});
const stepSlider = control("step", $("input", {type: "range", id: "step", min: 0, max: longest.steps.length - 1, step: 1}), stepOutput);
now.step = longest.steps.length - 1;
stepSlider.value = now.step;
stepSlider.disabled = longest.steps.length < 2;
const natural = Math.min(...runs.map(run => run.scale));
const scales = [...new Set([0, 1, natural, ...[0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].map(f => Number((f * natural).toPrecision(2)))])]
  .sort((a, b) => a - b);
const scaleSlider = control("displacements times", $("input", {type: "range", id: "scale", min: 0, max: scales.length - 1, step: 1}), scaleOutput);
scaleSlider.value = scales.indexOf(natural);
const box = (id, words, checked) => {
  const element = $("input", {type: "checkbox", id});
  element.checked = checked;
  return control(words, element);
};
const meshBox = box("mesh", "meshes", true), ghostBox = box("ghost", "as meshed", true), wideBox = box("wide", "same colours at all steps", false);
const whole = controls.appendChild($("button", {type: "button", id: "whole"}, "whole picture"));

const grid = page.appendChild($("div", {class: "runs"}));
const panels = runs.map((run, r) => {
  const canvas = $("canvas", {id: `canvas${r}`, tabindex: 0, role: "img", "aria-label": `Deformed bodies of ${run.name}. Arrow keys move, plus and minus zoom, 0 shows everything.`});
  const read = $("p", {class: "read", id: `read${r}`, "aria-live": "polite"}), bar = $("canvas", {width: 256, height: 1});
  const low = $("span"), high = $("span"), contact = $("div", {class: "contact"});
  grid.append($("section", {class: "run"}, $("h3", {}, $("i", {class: `dot b${r % 4}`}), run.name), $("div", {class: "picture"}, canvas), $("div", {class: "bar"}, low, bar, high), read, contact));
  return {run, r, canvas, read, bar, low, high, contact, context: canvas.getContext("2d")};
});

// ---- Colours ---------------------------------------------------------------------------------------------------------
const tables = Object.fromEntries(Object.entries(data.colours).map(([name, stops]) => {
  const rgb = stops.map(stop => [0, 2, 4].map(i => parseInt(stop.slice(i, i + 2), 16)));
  return [name, Uint32Array.from({length: 256}, (_, i) => {
    const at = i / 255 * (rgb.length - 1), k = Math.min(Math.floor(at), rgb.length - 2), f = at - k;
    const [red, green, blue] = rgb[k].map((each, c) => Math.round(each + f * (rgb[k + 1][c] - each)));
    return (255 << 24 | blue << 16 | green << 8 | red) >>> 0;
  })];
}));
function colourRange() {  // one for all runs; a corner must not take all the colours
  const signed = fieldOf(runs[0], now.field).signed;
  const found = runs.flatMap(run => (now.wide ? run.ranges : [run.ranges[stepOf(run)]]).map(each => each[now.field]));
  let low = Math.min(...found.map(each => each[0])), high = Math.max(...found.map(each => each[1])), cut = false;
  const top = Math.max(...found.map(each => each[2])), size = Math.max(Math.abs(low), Math.abs(high));
  if (signed) { cut = top < 0.7 * size && top > 0; high = cut ? top : size; low = -high; }
  else {
    cut = top < 0.7 * high && top > 0;
    if (cut) high = top;
    if (high - low > 0.5 * Math.abs(high)) low = Math.min(0, low);
  }
  if (!(high - low > 1e-9 * size)) { const margin = 0.1 * size || 1; low -= margin; high += margin; }
  return {low, high, cut, table: tables[signed ? "signed" : "plain"], signed};
}

// ---- Bodies: triangles are painted pixel by pixel, and each pixel knows its triangle -----------------------------------
let view = null, fit = true;  // centre and half width of what is seen, the same for all runs; fit: everything, next time
function everything() {
  let box = [Infinity, -Infinity, Infinity, -Infinity];
  for (const run of runs) run.bodies.forEach((body, b) => {
    const fields = run.steps[stepOf(run)].fields[b];
    for (let v = 0; v < body.vertices; v++) for (const s of [0, now.scale]) {
      const x = body.x[v] + s * scaled(fields.ux.q[v], fields.ux.e), y = body.y[v] + s * scaled(fields.uy.q[v], fields.uy.e);
      if (x < box[0]) box[0] = x; if (x > box[1]) box[1] = x;
      if (y < box[2]) box[2] = y; if (y > box[3]) box[3] = y;
    }
  });
  const width = Math.max(box[1] - box[0], 1e-300), height = Math.max(box[3] - box[2], 1e-300);
  const seen = panels[0].canvas.clientWidth || 1;
  const aspect = Math.min(Math.max(height / width, 0.5), 1.25, Math.max(0.5, 0.72 * window.innerHeight / seen));
  return {x: (box[0] + box[1]) / 2, y: (box[2] + box[3]) / 2, half: 0.53 * Math.max(width, height / aspect), aspect};
}
function paint(panel, range) {
  const {run, canvas, context} = panel, ratio = Math.min(window.devicePixelRatio || 1, 2);
  const w = Math.max(1, Math.round(canvas.clientWidth * ratio)), h = Math.max(1, Math.round(w * view.aspect));
  if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
  const image = context.createImageData(w, h), pixels = new Uint32Array(image.data.buffer);
  const owner = panel.owner && panel.owner.length === w * h ? panel.owner.fill(-1) : new Int32Array(w * h).fill(-1);
  const perLength = w / (2 * view.half), X = x => (x - view.x) * perLength + w / 2, Y = y => h / 2 - (y - view.y) * perLength;
  const step = stepOf(run), byVertex = fieldOf(run, now.field).vertex, lines = [], offsets = [];
  const colour = value => range.table[Math.max(0, Math.min(255, Math.floor((value - range.low) / (range.high - range.low) * 256)))];
  let first = 0;
  run.bodies.forEach((body, b) => {
    const fields = run.steps[step].fields[b], {corners, vertices, triangles} = body, px = new Float64Array(vertices), py = new Float64Array(vertices);
    for (let v = 0; v < vertices; v++) {
      px[v] = X(body.x[v] + now.scale * scaled(fields.ux.q[v], fields.ux.e));
      py[v] = Y(body.y[v] + now.scale * scaled(fields.uy.q[v], fields.uy.e));
    }
    const values = now.field === "u" ? real(fields.ux).map((x, v) => Math.hypot(x, scaled(fields.uy.q[v], fields.uy.e))) : real(fields[now.field]);
    let seen = 0, area = 0;
    for (let t = 0; t < triangles; t++) {
      const i = corners[3 * t], j = corners[3 * t + 1], k = corners[3 * t + 2];
      const ax = px[i], ay = py[i], bx = px[j], by = py[j], cx = px[k], cy = py[k];
      const top = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5)), end = Math.min(h - 1, Math.ceil(Math.max(ay, by, cy) - 0.5) - 1);
      if (Math.max(ax, bx, cx) < 0 || Math.min(ax, bx, cx) > w || Math.max(ay, by, cy) < 0 || Math.min(ay, by, cy) > h) continue;
      const det = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
      seen++; area += Math.abs(det) / 2;
      const flat = byVertex ? 0 : colour(values[t]);
      const gx = byVertex ? ((values[j] - values[i]) * (cy - ay) - (values[k] - values[i]) * (by - ay)) / det : 0;
      const gy = byVertex ? ((values[k] - values[i]) * (bx - ax) - (values[j] - values[i]) * (cx - ax)) / det : 0;
      for (let y = top; y <= end; y++) {
        const at = y + 0.5;
        let left = Infinity, right = -Infinity;
        for (let s = 0; s < 3; s++) {  // an edge cuts the row in the same place for both its triangles
          const ux = s === 0 ? ax : s === 1 ? bx : cx, uy = s === 0 ? ay : s === 1 ? by : cy;
          const vx = s === 0 ? bx : s === 1 ? cx : ax, vy = s === 0 ? by : s === 1 ? cy : ay;
          if ((uy <= at) === (vy <= at)) continue;
          const x = uy < vy ? ux + (at - uy) * (vx - ux) / (vy - uy) : vx + (at - vy) * (ux - vx) / (uy - vy);
          if (x < left) left = x; if (x > right) right = x;
        }
        const from = Math.max(0, Math.ceil(left - 0.5)), to = Math.min(w - 1, Math.ceil(right - 0.5) - 1), row = y * w;
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
        if (Math.max(px[i], px[j], px[k]) < 0 || Math.min(px[i], px[j], px[k]) > w || Math.max(py[i], py[j], py[k]) < 0 || Math.min(py[i], py[j], py[k]) > h) continue;
        context.moveTo(px[i], py[i]); context.lineTo(px[j], py[j]); context.lineTo(px[k], py[k]); context.closePath();
      }
      context.strokeStyle = "rgba(60,60,66,.35)"; context.lineWidth = 0.5 * ratio; context.stroke();
    }
    const outline = (x, y, dash, width, style) => {
      context.beginPath();
      body.from.forEach((v, i) => { context.moveTo(x(v), y(v)); context.lineTo(x(body.to[i]), y(body.to[i])); });
      context.setLineDash(dash); context.strokeStyle = style; context.lineWidth = width; context.stroke(); context.setLineDash([]);
    };
    if (now.ghost) outline(v => X(body.x[v]), v => Y(body.y[v]), [4 * ratio, 4 * ratio], 0.8 * ratio, "#8a8a92");
    outline(v => px[v], v => py[v], [], 0.9 * ratio, ink);
  }
  Object.assign(panel, {owner, offsets, step, px: lines.map(each => each.px), py: lines.map(each => each.py), ratio});
  const strip = panel.bar.getContext("2d"), shades = strip.createImageData(256, 1);
  new Uint32Array(shades.data.buffer).set(range.table);
  strip.putImageData(shades, 0, 0);
  panel.low.textContent = (range.cut && range.signed ? "\u2264 " : "") + short(range.low);
  panel.high.textContent = (range.cut ? "\u2265 " : "") + of(short(range.high), fieldOf(run, now.field).unit);
}
function hover(panel, x, y) {  // in CSS pixels of the canvas
  const {run, canvas, owner, ratio} = panel, i = Math.floor(x * ratio), j = Math.floor(y * ratio);
  const found = owner && i >= 0 && i < canvas.width && j >= 0 && j < canvas.height ? owner[j * canvas.width + i] : -1;
  if (found < 0) { panel.read.textContent = "Point at a triangle for its values; drag, wheel or keys move and zoom."; delete panel.read.dataset.triangle; return; }
  let b = run.bodies.length - 1;
  while (panel.offsets[b] > found) b--;
  const t = found - panel.offsets[b], body = run.bodies[b], fields = run.steps[panel.step].fields[b], field = fieldOf(run, now.field);
  const near = [0, 1, 2].map(c => body.corners[3 * t + c])
    .reduce((best, v) => Math.hypot(panel.px[b][v] - i, panel.py[b][v] - j) < Math.hypot(panel.px[b][best] - i, panel.py[b][best] - j) ? v : best);
  const value = valueOf(fields, now.field, field.vertex ? near : t);
  const say = (name, at) => `${name} ${of(valueOf(fields, name, at), fieldOf(run, name).unit)}`;
  const more = run.order.filter(name => /^s\d/.test(name)).map(name => say(name, t)).join(", ");
  panel.read.textContent = `${field.words} ${of(value, field.unit)} at ${body.name}, ` +
    `${field.vertex ? `vertex ${near}, ` : ""}triangle ${t}: ${more}; ${say("ux", near)}, ${say("uy", near)} at vertex ${near}; ` +
    `estimated error ${valueOf(fields, "error", t)}`;
  Object.assign(panel.read.dataset, {body: body.name, triangle: t, vertex: near, value});
}

// ---- Charts ----------------------------------------------------------------------------------------------------------
function ticks(low, high, count = 5) {
  const raw = (high - low) / count, unit = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].find(f => f * unit >= raw) * unit, found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) found.push(i * step);
  return found;
}
function below(x, y) {  // the part of a line below zero
  const points = [];
  x.forEach((each, i) => {
    if (i && (y[i] < 0) !== (y[i - 1] < 0)) points.push([x[i - 1] + (each - x[i - 1]) * y[i - 1] / (y[i - 1] - y[i]), 0]);
    points.push([each, Math.min(0, y[i])]);
  });
  return points;
}
function chart({title, xWords, series, small = 0, now: at, id, also = []}) {  // series: {x, y, run, marks, line, fill, name}
  const W = 460, H = 210, L = 62, R = 12, T = 24, B = 36;
  const xs = series.flatMap(s => [Math.min(...s.x), Math.max(...s.x)]), ys = [...also, ...series.flatMap(s => [Math.min(...s.y), Math.max(...s.y)])];
  let [x0, x1] = [Math.min(...xs), Math.max(...xs)], [y0, y1] = [Math.min(...ys), Math.max(...ys)];
  if (!(x1 > x0)) { x0 -= 0.5; x1 += 0.5; }
  if (y1 - y0 <= small) { const middle = (y0 + y1) / 2; y0 = middle - small; y1 = middle + small; }
  if (y1 - y0 <= 1e-9 * Math.max(Math.abs(y0), Math.abs(y1)) || y1 === y0) { const margin = 0.1 * Math.abs(y1) || 1; y0 -= margin; y1 += margin; }
  const pad = 0.06 * (y1 - y0); y0 -= pad; y1 += pad;
  const X = x => L + (x - x0) / (x1 - x0) * (W - L - R), Y = y => H - B - (y - y0) / (y1 - y0) * (H - T - B), n = v => v.toFixed(1);
  const element = svg("svg", {viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": title, ...(id ? {id} : {})}), label = svg("text", {x: L, y: 14});
  label.textContent = title;
  element.append(label);
  for (const y of ticks(y0, y1, 4)) element.append(svg("path", {class: "grid", d: `M${L} ${n(Y(y))}H${W - R}`}), svg("text", {x: L - 5, y: n(Y(y) + 4), "text-anchor": "end"}, short(y, 5)));
  for (const x of ticks(x0, x1, 5)) element.append(svg("path", {class: "grid", d: `M${n(X(x))} ${T}V${H - B}`}), svg("text", {x: n(X(x)), y: H - B + 14, "text-anchor": "middle"}, short(x, 5)));
  element.append(svg("text", {x: (L + W - R) / 2, y: H - 5, "text-anchor": "middle"}, xWords));
  if (y0 < 0 && y1 > 0) element.append(svg("path", {class: "zero", d: `M${L} ${n(Y(0))}H${W - R}`}));
  if (at !== undefined) element.append(svg("path", {class: "now", d: `M${n(X(at))} ${T}V${H - B}`}));
  for (const s of series) {
    const points = Array.from(s.x, (x, i) => `${n(X(x))} ${n(Y(s.y[i]))}`);
    if (s.fill) element.append(svg("path", {class: `under f${s.run % 4}`, d: `M${n(X(s.x[0]))} ${n(Y(0))}L${below(s.x, s.y).map(([x, y]) => `${n(X(x))} ${n(Y(y))}`).join("L")}L${n(X(s.x[s.x.length - 1]))} ${n(Y(0))}Z`}));
    if (s.line !== false && points.length > 1) element.append(svg("path", {class: `c${s.run % 4}`, d: "M" + points.join("L")}));
    if (s.marks || points.length === 1) Array.from(s.x, (x, i) => element.append(svg("circle", {class: `c${s.run % 4}`, cx: n(X(x)), cy: n(Y(s.y[i])), r: 2.6})));
  }
  element.addEventListener("pointermove", event => {
    const area = element.getBoundingClientRect(), px = (event.clientX - area.left) / area.width * W, py = (event.clientY - area.top) / area.height * H;
    let best = null, distance = 400;
    for (const s of series) for (let i = 0; i < s.x.length; i++) {
      const d = (X(s.x[i]) - px) ** 2 + (Y(s.y[i]) - py) ** 2;
      if (d < distance) { distance = d; best = [s, i]; }
    }
    label.textContent = best ? `${best[0].name}: ${short(best[0].x[best[1]], 6)}, ${best[0].y[best[1]]}` : title;
  });
  element.addEventListener("pointerleave", () => { label.textContent = title; });
  return element;
}
function drawContact(panel) {
  const {run, r} = panel, step = stepOf(run);
  panel.contact.replaceChildren(...run.lines.flatMap((line, k) => {
    const {pressure, gap, jump} = line.steps[step], small = 1e-9 * line.length, xWords = withUnit(line.name, run.units.length), where = `${line.nonmortar} on ${line.mortar}`;
    const others = runs.flatMap(each => each.lines[k] ? [each.lines[k].steps[stepOf(each)]] : []);  // on one scale with this run
    const range = name => others.flatMap(each => each[name] ? [Math.min(...each[name]), Math.max(...each[name])] : []);
    const drawn = jump ? [{x: jump[0], y: jump[1], run: r, fill: Math.min(...jump[1]) < -small, name: "gap between the nodes"}, {x: line.x, y: gap, run: r, marks: true, line: false, name: "gap of a node"}]
      : [{x: line.x, y: gap, run: r, marks: true, name: "gap of a node", fill: Math.min(...gap) < -small}];
    const jumps = others.flatMap(each => each.jump ? [Math.min(...each.jump[1]), Math.max(...each.jump[1])] : []);
    return [chart({id: `pressure${r}-${k}`, title: `contact pressure, ${withUnit(where, run.units.stress)}`, xWords, also: range("pressure"), series: [{x: line.x, y: pressure, run: r, marks: true, name: "pressure"}]}),
            chart({id: `gap${r}-${k}`, title: `gap, ${withUnit(where, run.units.length)}; marks: as the nodes see it`, xWords, small, also: [...range("gap"), ...jumps], series: drawn})];
  }));
}
const historyBox = $("div", {class: "charts", id: "histories"});
const leftOut = new Set(["step", "time", "rejections", "guarded", "factorisations", "joined", "left", "sign", "estimate"]);
function drawHistories() {
  const t = longest.steps[now.step].time, names = [...new Set(runs.flatMap(run => Object.keys(run.history.columns)))];
  historyBox.replaceChildren(...names.filter(name => !leftOut.has(name.split("[")[0])).flatMap(name => {
    const series = runs.flatMap((run, r) => {
      const columns = run.history.columns, time = columns[Object.keys(columns).find(each => each.startsWith("time["))], y = columns[name];
      return y && time && y.length > 1 ? [{x: time, y, run: r, name: run.name, marks: y.length < 25}] : [];
    });
    return series.some(s => s.y.some(v => v !== s.y[0])) ? [chart({title: name.replaceAll("_", " ").replace("[", " ["), xWords: withUnit("time", runs[0].units.time), series, now: t})] : [];
  }));
}

// ---- Everything together ---------------------------------------------------------------------------------------------
let waiting = null;
function redraw() {  // once a frame, when the data of the step are there
  if (waiting) return waiting;
  return waiting = (async () => {
    do {  // the slider may have moved on
      await Promise.all(runs.map(run => loadStep(run, stepOf(run))));
      await new Promise(requestAnimationFrame);
    } while (runs.some(run => !run.steps[stepOf(run)].fields));
    waiting = null;
    if (fit) { view = everything(); fit = false; }
    const range = colourRange();
    for (const panel of panels) {
      paint(panel, range);
      if (panel.last) hover(panel, ...panel.last); else hover(panel, -1, -1);
    }
  })();
}
async function change() {
  Object.assign(now, {field: fieldMenu.value, step: Number(stepSlider.value), scale: scales[Number(scaleSlider.value)], wide: wideBox.checked, mesh: meshBox.checked, ghost: ghostBox.checked});
  const step = longest.steps[now.step], words = `${step.step}, t = ${short(step.time, 6)} ${longest.units.time}`;
  stepOutput.textContent = words;
  stepSlider.setAttribute("aria-valuetext", words);
  scaleOutput.textContent = String(now.scale);
  scaleSlider.setAttribute("aria-valuetext", String(now.scale));
  panels.forEach(drawContact);
  drawHistories();
  await redraw();
}
for (const element of [fieldMenu, stepSlider, scaleSlider, wideBox, meshBox, ghostBox]) element.addEventListener("input", change);
whole.addEventListener("click", () => { fit = true; redraw(); });
function zoom(factor, x = view.x, y = view.y) {
  view = {...view, half: view.half * factor, x: x + (view.x - x) * factor, y: y + (view.y - y) * factor};
  redraw();
}
for (const panel of panels) {
  const {canvas} = panel, down = new Map();
  const length = () => 2 * view.half / canvas.clientWidth, point = event => {
    const area = canvas.getBoundingClientRect();
    return [event.clientX - area.left, event.clientY - area.top];
  };
  const place = ([x, y]) => [view.x + (x - canvas.clientWidth / 2) * length(), view.y - (y - canvas.clientHeight / 2) * length()];
  canvas.addEventListener("wheel", event => { event.preventDefault(); zoom(Math.exp(0.0015 * event.deltaY), ...place(point(event))); }, {passive: false});
  canvas.addEventListener("pointerdown", event => { down.set(event.pointerId, point(event)); canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointermove", event => {
    const to = point(event), from = down.get(event.pointerId);
    panel.last = to;
    if (from && down.size === 2) {
      const other = [...down].find(([id]) => id !== event.pointerId)[1], distance = p => Math.hypot(p[0] - other[0], p[1] - other[1]);
      if (distance(to) > 0) zoom(distance(from) / distance(to), ...place(other));
    } else if (from) {
      view = {...view, x: view.x - (to[0] - from[0]) * length(), y: view.y + (to[1] - from[1]) * length()};
      redraw();
    } else hover(panel, ...to);
    if (from) down.set(event.pointerId, to);
  });
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, event => { down.delete(event.pointerId); hover(panel, ...(panel.last = point(event))); });
  canvas.addEventListener("pointerleave", () => { if (!down.size) { panel.last = null; hover(panel, -1, -1); } });
  canvas.addEventListener("dblclick", () => { fit = true; redraw(); });
  canvas.addEventListener("keydown", event => {
    const step = 0.1 * view.half, move = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]}[event.key];
    if (move) { view = {...view, x: view.x + move[0], y: view.y + move[1]}; redraw(); }
    else if (event.key === "+" || event.key === "=") zoom(0.8);
    else if (event.key === "-") zoom(1.25);
    else if (event.key === "0") { fit = true; redraw(); }
    else return;
    event.preventDefault();
  });
}
new ResizeObserver(() => { if (view) redraw(); }).observe(grid);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => redraw());

page.append($("h2", {}, "Histories"));
if (runs.length > 1) page.append($("div", {class: "key"}, ...runs.map((run, r) => $("span", {}, $("i", {class: `b${r % 4}`}), run.name))));
page.append(historyBox);
for (const run of runs) if (run.history.every > 1) page.append($("p", {class: "soft"}, `${run.name}: every ${run.history.every}th row of history.csv is drawn.`));
for (const title of Object.keys(runs[0].tables)) {
  const keys = [...new Set(runs.flatMap(run => run.tables[title].map(([key]) => key)))];
  const table = $("table", {}, $("tr", {}, $("th", {}, ""), ...runs.map(run => $("th", {}, run.name))));
  for (const key of keys)
    table.append($("tr", {}, $("td", {}, key.replaceAll("_", " ")), ...runs.map(run => $("td", {}, (run.tables[title].find(each => each[0] === key) || ["", ""])[1]))));
  page.append($("h2", {}, title), $("div", {class: "wide"}, table));
}
page.append($("h2", {}, "What was modelled and left out"));
for (const run of runs) {
  if (!run.plan) { page.append($("p", {class: "soft"}, `${run.name}: not known: the scene is not where it was, or not as it was.`)); continue; }
  const rows = run.plan.map(([modelled, part, what, why]) => $("tr", {}, $("td", {}, modelled ? "modelled" : "left out"), $("td", {}, part), $("td", {}, what), $("td", {}, why)));
  page.append($("details", {}, $("summary", {}, run.name), $("div", {class: "wide"}, $("table", {}, ...rows))));
}
page.append($("h2", {}, "Scene"));
for (const run of runs)
  page.append($("details", {}, $("summary", {}, `${run.name}: ${run.path}`), $("pre", {class: "scene"}, run.scene === null ? "not kept in this result" : run.scene)));

await Promise.all(runs.flatMap(run => run.bodies.map(loadMesh)));
await change();
document.documentElement.dataset.ready = String(Math.round(performance.now()));
})();

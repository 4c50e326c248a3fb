const data = JSON.parse(document.getElementById("data").textContent), runs = data.runs;
const $ = (tag, attributes = {}, ...children) => put(document.createElement(tag), attributes, children);
const svg = (tag, attributes = {}, ...children) => put(
    document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
function put(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}
const withUnit = (words, unit) => unit ? `${words} [${unit}]` : words;
const of = (value, unit) => unit ? `${value} ${unit}` : String(value);
function short(value, digits = 4) {  // 0.00002 as 2e-5
  const rounded = Number(value.toPrecision(digits)), size = Math.abs(rounded);
  return size > 0 && size < 1e-3 ? rounded.toExponential() : String(rounded);
}

// ---- Data (views/coding.py): integers times 10^e, differences, deflated -----------------------------------
const powers = Array.from({length: 309}, (_, e) => Number(`1e${e}`));
const scaled = (q, e) => e >= 0 ? q * powers[e] : q / powers[-e];
async function unpack(text) {
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = letters.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
async function arrays(block, lengths, later = []) {  // [{e, q}]; later: of the block that it differs from
  const bytes = await unpack(block.d);
  let at = 0;
  return lengths.map((n, k) => {
    const q = new Float64Array(n), [e, fromLater] = block.f[k], old = fromLater ? later[k].q : null;
    for (let i = 0; i < n; i++) {
      const j = at + i;
      const folded = bytes[j] | bytes[j + n] << 8 | bytes[j + 2 * n] << 16 | bytes[j + 3 * n] << 24;
      q[i] = (folded >>> 1 ^ -(folded & 1)) + (old ? old[i] : i ? q[i - 1] : 0);
    }
    at += 4 * n;
    return {e, q};
  });
}
function real({e, q}) {
  const values = new Float64Array(q.length);
  for (let i = 0; i < q.length; i++) values[i] = scaled(q[i], e);
  return values;
}
const loadStep = (run, i) => run.steps[i].loaded ??= readStep(run, i);
async function readStep(run, i) {  // body number -> field name -> {e, q}
  const step = run.steps[i], names = run.order, n = names.length;
  if (i + 1 < run.steps.length) await loadStep(run, i + 1);
  const all = step.all = await arrays(
      step, run.bodies.flatMap(body => names.map(name => lengthOf(run, body, name))), run.steps[i + 1]?.all);
  step.fields = run.bodies.map((body, b) => {
    const fields = Object.fromEntries(names.map((name, k) => [name, all[b * n + k]]));
    if (!data.space) fields.von_mises = invariant(fields);
    return {...fields, region: body.region};
  });
}
const stressOf = (fields, values) => ["11", "22", "33", "12", "23", "13"].map(
    component => fields[`s${component}`] && values(fields[`s${component}`]));
function invariant(fields) {  // with a digit as small as those of the components
  const e = Math.max(...stressOf(fields, each => each.e).filter(each => each !== undefined));
  return {e, q: vonMises(stressOf(fields, real)).map(value => Math.floor(scaled(value, -e) + 0.5))};
}
function vonMises([s11, s22, s33, ...others]) {
  const shears = others.filter(Boolean);
  return s11.map((a, i) => {
    const b = s22[i], c = s33 ? s33[i] : 0;
    let shear = 0;
    for (const each of shears) shear += each[i] * each[i];
    return Math.sqrt(Math.max(a * a + b * b - a * b + c * (c - a - b) + 3 * shear, 0));
  });
}
function trianglesOf(first, second, third) {  // their corners, from what the others are more than the first
  const found = new Int32Array(3 * first.length);
  for (let i = 0; i < first.length; i++) {
    found[3 * i] = first[i];
    found[3 * i + 1] = first[i] + second[i];
    found[3 * i + 2] = first[i] + third[i];
  }
  return found;
}
const fieldOf = (run, name) => run.fields.find(field => field.name === name);

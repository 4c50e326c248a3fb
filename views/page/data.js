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

// ---- Data (views/coding.py): integers times 10^e, predicted, deflated -------------------------------------
const powers = Array.from({length: 309}, (_, e) => Number(`1e${e}`));
const scaled = (q, e) => e >= 0 ? q * powers[e] : q / powers[-e];
async function unpack(text) {
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = letters.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
// [{e, q}] of a block; predict: of what is predicted by the caller, else by 0
function arrays(bytes, forms, lengths, later, predict = (found, k) => new Float64Array(lengths[k])) {
  const found = [];
  let at = 0;
  forms.forEach(([e, how, weights], k) => {
    const n = lengths[k], q = new Float64Array(n), plane = n;
    let before = 0;
    for (let w = weights - 1; w >= 0; w--)
      for (let i = 0; i < n; i++) q[i] = q[i] * 256 + bytes[at + w * plane + i];
    let guess = how === 2 ? predict(found, k, e) : null;
    if (how === 1 || how === 3) {
      guess = new Float64Array(n);
      const add = (blocks, factor) => {  // the same array of a later step, times 10^e
        const {e: e0, q: old} = later[blocks - 1][k];
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
const loadStep = (run, i) => run.steps[i].loaded ??= readStep(run, i);
async function readStep(run, i) {  // body number -> field name -> {e, q}
  const step = run.steps[i];
  const back = Math.max(...step.f.map(
            form => form[1] === 3 ? 2
                : form[1] === 1   ? 1
                                  : 0)),
        later = [];  // steps that it needs
  for (let k = 1; k <= back; k++) { await loadStep(run, i + k); later.push(run.steps[i + k].all); }
  const bytes = await unpack(step.d), names = run.order, n = names.length;
  const lengths = run.bodies.flatMap(body => names.map(name => lengthOf(run, body, name)));
  const stresses = stressNames.filter(name => names.includes(name));
  step.all = arrays(bytes, step.f, lengths, later, (found, k, e) => {
    const first = k - k % n, s = stresses.map(name => found[first + names.indexOf(name)]);
    const all = s.map(real);
    return Float64Array.from(all[0], (_, j) => Math.floor(scaled(vonMises(all, j), -e) + 0.5));
  });
  step.fields = run.bodies.map((body, b) =>
    ({...Object.fromEntries(names.map((name, k) => [name, step.all[b * n + k]])), region: body.region}));
}
const stressNames = ["s11", "s22", "s12", "s33"];
function vonMises([s11, s22, s12, s33], i) {
  const a = s11[i], b = s22[i], c = s12[i], d = s33 ? s33[i] : 0;
  return Math.sqrt(Math.max(a * a + b * b - a * b + d * (d - a - b) + 3 * c * c, 0));
}
const fieldOf = (run, name) => run.fields.find(field => field.name === name);

// ---- Values as they are shown -----------------------------------------------------------------------------
// Stresses and strains are constant in triangles. Recovered ones are their means at the vertices, weighted by
// area, of each region by itself, and linear between.
function averaged(body, values) {  // one value for each corner of the triangles
  const {corners, part, parts, area} = body, sums = new Float64Array(body.vertices * parts),
        weights = new Float64Array(body.vertices * parts), found = new Float64Array(corners.length);
  for (let i = 0; i < corners.length; i++) {
    const t = Math.floor(i / 3), at = corners[i] * parts + part[t];
    sums[at] += area[t] * values[t];
    weights[at] += area[t];
  }
  for (let i = 0; i < corners.length; i++) {
    const at = corners[i] * parts + part[Math.floor(i / 3)];
    found[i] = sums[at] / (weights[at] || 1);
  }
  return found;
}
function shownValues(run, step, b) {  // {flat}: values by triangle, or {corner}: by corner
  const body = run.bodies[b], fields = run.steps[step].fields[b], name = now.field;
  if (fieldOf(run, name).vertex) {
    const {ux, uy} = fields, length = (x, v) => Math.hypot(x, scaled(uy.q[v], uy.e));
    const at = name === "u" ? real(ux).map(length) : real(fields[name]);
    return {corner: Float64Array.from(body.corners, v => at[v])};
  }
  if (now.raw || !recoverable(name)) return {flat: real(fields[name])};
  if (name !== "von_mises") return {corner: averaged(body, real(fields[name]))};
  return {corner: vonMises(stressOf(fields, each => averaged(body, real(each))))};
}
function valueOf(fields, name, i) {  // a number with the decimals that it has
  if (name === "u") {
    const x = fields.ux, y = fields.uy;
    return Number(Math.hypot(scaled(x.q[i], x.e), scaled(y.q[i], y.e)).toPrecision(4));
  }
  const {e, q} = fields[name];
  return Number(`${q[i]}e${e}`) || 0;
}
const lengthOf = (run, body, name) => fieldOf(run, name).vertex ? body.vertices : body.triangles;
async function loadMesh(body) {
  const {vertices: nv, triangles: nt, edges: ne} = body;
  const a = await arrays(body.mesh, [nv, nv, nt, nt, nt, ne, ne, ne, ne, nt]);
  const t = trianglesOf(a[2].q, a[3].q, a[4].q);
  const from = a[5].q, middle = from.map((v, i) => v + a[8].q[i]);  // = from where sides are straight
  Object.assign(body, {
    x: real(a[0]), y: real(a[1]), corners: t, from, to: a[6].q, owner: a[7].q, middle, region: a[9]
  });
  const numbers = new Map();  // of the regions, from 0
  body.part = Int32Array.from(a[9].q, r => numbers.get(r) ?? numbers.set(r, numbers.size).get(r));
  body.parts = Math.max(1, numbers.size);
  const {x, y} = body;
  body.area = new Float64Array(nt);
  for (let i = 0; i < nt; i++) {
    const p = t[3 * i], q = t[3 * i + 1], r = t[3 * i + 2];
    body.area[i] = Math.abs((x[q] - x[p]) * (y[r] - y[p]) - (x[r] - x[p]) * (y[q] - y[p])) / 2;
  }
}

// ---- Values as they are shown -----------------------------------------------------------------------------
// Stresses and strains are constant in triangles. Recovered ones are their means at the vertices, weighted by
// area, of each region by itself, and linear between.
const recoverable = name => /^[se]\d\d$|^von_mises$/.test(name);
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
  const all = stressNames.filter(each => fields[each]).map(each => averaged(body, real(fields[each])));
  return {corner: Float64Array.from(all[0], (_, i) => vonMises(all, i))};
}
function extremes(shown) {  // the largest value of the bodies, and the smallest: value, b, t, corner
  const found = [null, null];
  shown.forEach(({flat, corner}, b) => {
    const values = flat || corner;
    let most = 0, least = 0;
    for (let i = 1; i < values.length; i++) {
      if (values[i] > values[most]) most = i;
      if (values[i] < values[least]) least = i;
    }
    const place = i => ({value: values[i], b, t: flat ? i : Math.floor(i / 3), corner: flat ? -1 : i % 3});
    if (values.length && !(values[most] <= found[0]?.value)) found[0] = place(most);
    if (values.length && !(values[least] >= found[1]?.value)) found[1] = place(least);
  });
  return found;
}

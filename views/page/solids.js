// ---- Bodies in space (views/solids.py): vertices of the page, then the middles of quadratic sides ---------
const WITH_MIDDLES = /^(u[xyz])_middles$/;
// A quadratic side as four triangles of its corners and middles, and which sides of these lie along its own.
const QUARTERS = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]];
const ALONG = [[0, 1, 1], [1, 0, 1], [1, 1, 0], [0, 0, 0]];
function lengthOf(run, body, name) {
  if (WITH_MIDDLES.test(name)) return body.middles;
  return fieldOf(run, name).contact ? body.touching : body.vertices;
}
async function loadMesh(body) {
  const {vertices: n, middles: m, triangles: t, tetrahedra: e, touching: k} = body;
  const a = await arrays(body.mesh, [n, n, n, m, m, m, t, t, t, t, e, e, e, e, n]);
  body.contactNodes = (await arrays(body.contact, [k]))[0].q;
  const cells = new Int32Array(4 * e), q = i => a[i].q, corners = trianglesOf(q(6), q(7), q(8));
  for (let i = 0; i < e; i++)
    for (let c = 0, v = 0; c < 4; c++) cells[4 * i + c] = v += q(10 + c)[i];
  Object.assign(body, {cells, region: a[14], ...sidesOf(corners, n, m)});
  body.points = [0, 1, 2].map(c => withMiddles(body, real(a[c]), real(a[3 + c])));
  setDrawn(body, corners, q(9));
}
function sidesOf(corners, n, m) {  // of middles both ends; of triangles the middles, in the order of sides
  const ends = new Int32Array(2 * m), middleOf = new Int32Array(m ? corners.length : 0), met = new Map();
  for (let i = 0; i < middleOf.length; i++) {
    const p = corners[i], q = corners[i % 3 === 2 ? i - 2 : i + 1];
    const side = Math.min(p, q) * n + Math.max(p, q);
    let number = met.get(side);
    if (number === undefined) {
      met.set(side, number = met.size);
      ends[2 * number] = p;
      ends[2 * number + 1] = q;
    }
    middleOf[i] = n + number;
  }
  return {ends, middleOf};
}
function setDrawn(body, corners, marks) {  // triangles as they are drawn, those of contact surfaces last
  const order = [...marks.keys()].sort((i, j) => (marks[i] >> 3) - (marks[j] >> 3) || i - j);
  const parts = body.middles ? 4 : 1, drawn = new Int32Array(3 * parts * order.length),
        sharp = new Uint8Array(9 * parts * order.length);  // of each corner: 1 mesh, 2 edge, of three sides
  let at = 0;
  const add = (nodes, sides) => {
    for (let c = 0; c < 3; c++, at++) { drawn[at] = nodes[c]; sharp.set(sides, 3 * at); }
  };
  body.contactFrom = 3 * parts * order.findIndex(i => marks[i] >> 3);
  if (body.contactFrom < 0) body.contactFrom = drawn.length;
  for (const i of order) {
    const nodes = corners.subarray(3 * i, 3 * i + 3), sides = [0, 1, 2].map(c => 1 + (marks[i] >> c & 1));
    if (!body.middles) { add(nodes, sides); continue; }
    const six = [...nodes, ...body.middleOf.subarray(3 * i, 3 * i + 3)];
    QUARTERS.forEach((quarter, k) => add(quarter.map(c => six[c]), sides.map((s, c) => s * ALONG[k][c])));
  }
  Object.assign(body, {drawn, sharp});
}
function withMiddles(body, values, missed) {  // of vertices, and of the middles of sides
  const {vertices: n, middles: m, ends} = body, found = new Float64Array(n + m);
  found.set(values);
  for (let i = 0; i < m; i++)
    found[n + i] = (values[ends[2 * i]] + values[ends[2 * i + 1]]) / 2 + (missed ? missed[i] : 0);
  return found;
}
function nodalValues(run, step, b, name) {  // by vertex and middle; not a number off the contact surfaces
  const body = run.bodies[b], fields = run.steps[step].fields[b], known = run.steps[step].nodal ??= [];
  known[b] ??= {};
  return known[b][name] ??= (() => {
    if (/^u[xyz]$/.test(name)) return withMiddles(body, real(fields[name]), real(fields[`${name}_middles`]));
    if (name === "u") {
      const [x, y, z] = ["ux", "uy", "uz"].map(each => nodalValues(run, step, b, each));
      return x.map((each, i) => Math.hypot(each, y[i], z[i]));
    }
    if (body.rigid && name !== "region" && !fieldOf(run, name).contact)  // tools have no stress
      return new Float64Array(body.vertices + body.middles).fill(NaN);
    if (name === "von_mises") return withMiddles(body, vonMises(stressOf(fields, real)));
    if (!fieldOf(run, name).contact) return withMiddles(body, real(fields[name]));
    const values = new Float64Array(body.vertices).fill(NaN), given = real(fields[name]);
    body.contactNodes.forEach((v, i) => { values[v] = given[i]; });
    return withMiddles(body, values);
  })();
}
function placed(run, step, b, scale) {  // x, y, z of vertices and middles
  const body = run.bodies[b];
  return ["ux", "uy", "uz"].map((name, c) => {
    if (!scale) return body.points[c];
    const moved = nodalValues(run, step, b, name);
    return body.points[c].map((x, i) => x + scale * moved[i]);
  });
}

// ---- The plane that cuts ----------------------------------------------------------------------------------
// Where a plane n x = d meets tetrahedra: of each corner of its triangles two nodes and the part of the
// second, and which sides of the triangle are drawn.
function section(body, [x, y, z], normal, d) {
  const {cells} = body, from = [], to = [], part = [], sides = [];
  const height = new Float64Array(body.vertices);
  for (let v = 0; v < body.vertices; v++)
    height[v] = normal[0] * x[v] + normal[1] * y[v] + normal[2] * z[v] - d;
  for (let t = 0; t < cells.length; t += 4) {
    const below = [], above = [];
    for (let c = t; c < t + 4; c++) (height[cells[c]] < 0 ? below : above).push(cells[c]);
    if (!below.length || !above.length) continue;
    const [a, b] = below.length < above.length ? [below, above] : [above, below];
    const cuts = a.length === 1 ? b.map(v => [a[0], v])
                                : [[a[0], b[0]], [a[0], b[1]], [a[1], b[1]], [a[1], b[0]]];
    for (let i = 2; i < cuts.length; i++) {
      [cuts[0], cuts[i - 1], cuts[i]].forEach(([p, q]) => {
        from.push(p);
        to.push(q);
        part.push(height[p] / (height[p] - height[q]));
        sides.push(1, cuts.length === 4 && i === 2 ? 0 : 1, cuts.length === 4 && i === 3 ? 0 : 1);
      });
    }
  }
  return {from, to, part, sides};
}

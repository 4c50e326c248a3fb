// ---- Bodies in space: painted, cut, hovered; their controls and keys --------------------------------------
Object.assign(now, {hidden: new Set(), cut: {axis: -1, part: 0.5, flip: 1}});
const viewNames = Object.keys(runs[0].views);
for (const name of viewNames) {
  const button = controls.appendChild($("button", {type: "button", id: `view-${name}`}, name));
  button.addEventListener("click", () => {
    for (const group of groups.values()) if (group.runs[0].views[name]) seen(group, name);
    redraw();
  });
}
const bodyNames = [...new Set(runs.flatMap(run => run.bodies.map(body => body.name)))];
const bodyBoxes = bodyNames.map((name, i) => {
  const element = box(`body${i}`, name, true);
  element.value = name;
  element.addEventListener("input", () => {
    now.hidden[element.checked ? "delete" : "add"](name);
    redraw();
  });
  return element;
});
const cutMenu = choice("cut", "cut", [["-1", "none"], ["0", "x"], ["1", "y"], ["2", "z"]]);
const cutSlider = control("at", $("input", {type: "range", id: "cut-at", min: 0, max: 1000, value: 500}),
                          $("output", {for: "cut-at"}));
const flipButton = controls.appendChild($("button", {type: "button", id: "flip"}, "other half"));
function cutChanged() {
  const axis = Number(cutMenu.value);
  if (axis >= 0 && axis !== now.cut.axis) {  // what is in front of the plane is cut off
    const {camera, target} = panels[0].run.group;
    now.cut.flip = camera.position.getComponent(axis) < target.getComponent(axis) ? -1 : 1;
  }
  Object.assign(now.cut, {axis, part: Number(cutSlider.value) / 1000});
  redraw();
}
for (const element of [cutMenu, cutSlider]) element.addEventListener("input", cutChanged);
flipButton.addEventListener("click", () => { now.cut.flip *= -1; redraw(); });
valuesMenu.parentElement.hidden = true;  // all are by vertex

function paint(panel, range) {
  if (!turning) return;
  if (!panel.bodies) startBodies(panel);
  const {run} = panel, {group} = run, step = stepOf(run), field = fieldOf(run, now.field);
  group.shades.image.data.set(new Uint8Array(range.table.buffer));
  group.shades.needsUpdate = true;
  const cut = setPlane(group), ink = getComputedStyle(document.body).color;
  for (const each of panel.bodies) {
    const {body, b, solid, edges, ghost} = each, shown = !now.hidden.has(body.name);
    const where = [step, now.scale].join(), what = [step, now.field].join();
    if (each.where !== where) {
      each.where = where;
      each.placed = placed(run, step, b, now.scale).map((values, c) => scenic(group, values, c));
      fill(solid.geometry.attributes.position, body.drawn, each.placed);
      solid.geometry.computeBoundingSphere();
      setLines(edges, body, each.placed);
      setLines(ghost, body, placed(run, step, b, 0).map((values, c) => scenic(group, values, c)));
    }
    if (each.what !== what) {
      each.what = what;
      each.values = nodalValues(run, step, b, now.field);
      fill(solid.geometry.attributes.value, body.drawn, [each.values]);
    }
    solid.visible = shown;
    edges.visible = shown && field.contact;
    ghost.visible = shown && now.ghost;
    edges.material.color.set(ink);
    setMaterials(each, range, field, cut ? [group.plane] : []);
    setSection(each, cut, !field.contact && shown && body.tetrahedra > 0);
  }
  render(panel);
  const place = ({b, i}) => run.bodies[b].points.map(each => each[i]);
  tellExtremes(panel, range, extremes(panel.bodies.map(each => each.values)), place,
               run.interior || field.contact ? "" : " (on the surface)");
  drawLegend(panel, range);
}
const scenic = (group, values, c) => {
  const middle = group.middle.getComponent(c);
  return values.map(x => (x - middle) / group.size);
};
function fill(attribute, nodes, parts) {  // one number, or three, of every corner
  const {array} = attribute, size = parts.length;
  for (let i = 0; i < nodes.length; i++)
    for (let c = 0; c < size; c++) array[size * i + c] = parts[c][nodes[i]];
  attribute.needsUpdate = true;
}
function setLines(lines, {drawn, sharp}, [x, y, z]) {  // edges of the surface
  const points = [];
  for (let i = 0; i < drawn.length; i += 3) for (let c = 0; c < 3; c++) {
      if (sharp[3 * i + c] < 2) continue;
      const [p, q] = [drawn[i + (c + 1) % 3], drawn[i + (c + 2) % 3]];
      if (p < q) points.push(x[p], y[p], z[p], x[q], y[q], z[q]);
    }
  lines.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
  if (lines.material.isLineDashedMaterial) lines.computeLineDistances();
}
function setMaterials({body, solid, cut, edges, ghost}, range, field, planes) {
  solid.material.forEach((each, k) => {
    const glass = field.contact && !k;  // contact surfaces are seen through the bodies
    Object.assign(each, {transparent: field.contact, depthWrite: !glass, clippingPlanes: planes});
    each.uniforms.glass.value = glass;
  });
  solid.renderOrder = field.contact ? body.touching ? 1 : 0 : 0;
  edges.material.clippingPlanes = planes;
  ghost.material.clippingPlanes = planes;
  for (const {uniforms} of [...solid.material, cut.material])
    Object.entries({low: range.low, high: range.high, ratio: pixelRatio(), mesh: now.mesh ? 1 : 0})
        .forEach(([name, value]) => { uniforms[name].value = value; });
}

// ---- The cut ----------------------------------------------------------------------------------------------
function setPlane(group) {  // in the scene: normal and distance; what is above is cut off
  const {axis, part, flip} = now.cut;
  cutSlider.parentElement.hidden = flipButton.hidden = axis < 0;
  if (axis < 0) return null;
  const box = boxOf(group, now.scale), low = box.min.getComponent(axis), high = box.max.getComponent(axis);
  const at = low + part * (high - low), normal = [0, 0, 0];
  controls.querySelector("output[for=cut-at]").textContent = short(at, 4);
  normal[axis] = flip;
  const d = flip * (at - group.middle.getComponent(axis)) / group.size;
  group.plane.normal.set(...normal).negate();
  group.plane.constant = d;
  return {normal, d};
}
function setSection(each, cut, wanted) {
  const {body, values, placed: place} = each;
  each.cut.visible = Boolean(cut && wanted);
  if (!each.cut.visible) return;
  const found = each.section = section(body, place, cut.normal, cut.d), n = found.from.length;
  const at = new Float32Array(3 * n), value = new Float32Array(n), corner = new Uint8Array(3 * n);
  for (let i = 0; i < n; i++) {
    const mix = of => of[found.from[i]] + found.part[i] * (of[found.to[i]] - of[found.from[i]]);
    place.forEach((of, c) => { at[3 * i + c] = mix(of); });
    value[i] = mix(values);
    corner[3 * i + i % 3] = 1;
  }
  each.cut.geometry.dispose();
  each.cut.geometry = new THREE.BufferGeometry();
  Object.entries({position: [at, 3], value: [value, 1], at: [corner, 3],
                  sides: [Uint8Array.from(found.sides), 3]})
      .forEach(([name, of]) => each.cut.geometry.setAttribute(name, new THREE.BufferAttribute(...of)));
  each.cut.geometry.computeBoundingSphere();
}

// ---- Values under the pointer -----------------------------------------------------------------------------
function pick(panel, x, y) {  // body, three pairs of nodes with the part of the second, and their weights
  const {caster, canvas, run: {group}} = panel, planes = now.cut.axis < 0 ? null : group.plane;
  caster.setFromCamera(
      new THREE.Vector2(2 * x / canvas.clientWidth - 1, 1 - 2 * y / canvas.clientHeight), group.camera);
  const contact = fieldOf(panel.run, now.field).contact, found = [];
  for (const each of panel.bodies) {
    if (each.solid.visible) caster.intersectObject(each.solid).forEach(hit => {
      if (planes && planes.distanceToPoint(hit.point) < 0) return;
      if (!contact || hit.face.materialIndex === 1) found.push({each, hit, cut: false});
    });
    if (each.cut.visible) caster.intersectObject(each.cut).forEach(hit => found.push({each, hit, cut: true}));
  }
  if (!found.length) return null;
  const {each, hit, cut} = found.reduce((a, b) => b.hit.distance < a.hit.distance ? b : a);
  const corners = [hit.face.a, hit.face.b, hit.face.c];
  const place = (cut ? each.cut : each.solid).geometry.attributes.position, weights = new THREE.Vector3();
  THREE.Triangle.getBarycoord(
      hit.point, ...corners.map(i => new THREE.Vector3().fromBufferAttribute(place, i)), weights);
  const {drawn} = each.body, {from, to, part} = each.section || {};
  return {each, weights: weights.toArray(),
          nodes: corners.map(i => cut ? [from[i], to[i], part[i]] : [drawn[i], drawn[i], 0])};
}
function hover(panel, x, y) {  // in CSS pixels of the canvas
  if (!turning || !panel.bodies) return;
  const {run, read} = panel, found = x < 0 ? null : pick(panel, x, y);
  for (const name of Object.keys(read.dataset)) delete read.dataset[name];
  if (!found) {
    read.textContent = "Point at a body for its values. Drag or arrow keys turn, wheel or + and - zoom, " +
        "right button, two fingers or shift and arrow keys move, 0 shows everything.";
    return;
  }
  const {each: {body, b}, nodes, weights} = found, step = stepOf(run);
  const at = of => nodes.reduce(
      (sum, [p, q, part], i) => sum + weights[i] * (of[p] + part * (of[q] - of[p])), 0);
  const valueAt = name => at(nodalValues(run, step, b, name));
  const say = name => {
    const value = valueAt(name), field = fieldOf(run, name);
    return value === value ? [`${field.words} ${of(short(value, 4), field.unit)}`] : [];
  };
  const place = body.points.map(at), value = valueAt(now.field);
  const others = ["pressure", "gap", "von_mises", "ux", "uy", "uz", "error"].filter(
      name => name !== now.field && fieldOf(run, name));
  read.textContent = `${say(now.field)} in ${body.name} at (${
      place.map(c => short(c, 4)).join(", ")}) as meshed: ${others.flatMap(say).join(", ")}`;
  Object.assign(read.dataset, {body: body.name, value, x: place[0], y: place[1], z: place[2]});
}

// ---- Pointers and keys ------------------------------------------------------------------------------------
for (const panel of panels) {
  const {canvas} = panel, {group} = panel.run;
  const tell = event => hover(panel, ...(panel.last = pointIn(canvas, event)));
  canvas.addEventListener("pointermove", event => {
    if (!event.buttons && event.pointerType === "mouse") requestAnimationFrame(() => tell(event));
  });
  canvas.addEventListener("pointerup", tell);
  canvas.addEventListener("pointerleave", event => {
    if (event.pointerType === "mouse" && !event.buttons) { panel.last = null; hover(panel, -1, -1); }
  });
  canvas.addEventListener("dblclick", () => showAll(group));
  canvas.addEventListener("keydown", event => {
    if (!turning) return;
    const way = WAYS[event.key], view = viewNames[event.key - 1];
    const {camera, target} = group, [azimuth, elevation] = anglesOf(group);
    if (way && event.shiftKey) {
      const e = camera.matrixWorld.elements, far = 0.1 / camera.zoom;
      target.add(new THREE.Vector3(e[0], e[1], e[2]).multiplyScalar(way[0] * far))
          .add(new THREE.Vector3(e[4], e[5], e[6]).multiplyScalar(way[1] * far));
      lookFrom(group, [azimuth, elevation]);
    } else if (way) lookFrom(group, [azimuth + 10 * way[0], elevation + 10 * way[1]]);
    else if ("+=-".includes(event.key)) camera.zoom *= event.key === "-" ? 0.8 : 1.25;
    else if (event.key === "0") showAll(group);
    else if (view && group.runs[0].views[view]) seen(group, view);
    else return;
    event.preventDefault();
    redraw();
  });
}

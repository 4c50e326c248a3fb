// ---- Bodies in space, turned: three.js draws, its OrbitControls has mouse and touch -----------------------
const START = [-60, 25], FAR_AWAY = 10, NEAR_CONTACT = 0.4;  // of the size of the contact, about it
const LEAST_CONTACT = 0.05;  // of the bodies: so large is a contact at least in a view of it
const VERTEX = `attribute float value; attribute vec3 at, sides; varying float v; varying vec3 b, s, p;
#include <clipping_planes_pars_vertex>
void main() {
  v = value; b = at; s = sides;
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  p = mvPosition.xyz;
  gl_Position = projectionMatrix * mvPosition;
  #include <clipping_planes_vertex>
}`;
const FRAGMENT = `precision highp float;
uniform sampler2D colours; uniform float low, high, ratio, mesh; uniform vec3 plain; uniform bool glass;
varying float v; varying vec3 b, s, p;
#include <clipping_planes_pars_fragment>
void main() {
  #include <clipping_planes_fragment>
  vec3 n = normalize(cross(dFdx(p), dFdy(p)));
  n *= n.z < 0.0 ? -1.0 : 1.0;
  float light = 0.78 + 0.22 * clamp(dot(n, vec3(-0.36, 0.55, 0.75)), 0.0, 1.0);
  float shade = (clamp((v - low) / (high - low), 0.0, 1.0) * 1023.0 + 0.5) / 1024.0;
  vec3 c = light * texture2D(colours, vec2(shade, 0.5)).rgb;
  vec3 tall = 1.0 / max(sqrt(dFdx(b) * dFdx(b) + dFdy(b) * dFdy(b)), vec3(1e-9));  // heights in pixels
  vec3 near = clamp(0.5 * ratio + 0.5 - b * tall, 0.0, 1.0);
  vec3 weak = 0.45 * clamp((tall / ratio - 3.0) / 9.0, 0.0, 1.0) * mesh;  // small elements are not dark
  vec3 line = near * (step(0.5, s) * weak * (1.0 - step(1.5, s)) + step(1.5, s) * 0.85);
  float ink = max(line.x, max(line.y, line.z));
  if (glass) gl_FragColor = vec4(plain, 0.07 + 0.3 * pow(1.0 - n.z, 2.0));
  else gl_FragColor = vec4(mix(c, vec3(0.15), ink), 1.0);
}`;
let turning = false;  // once there is something to draw with
document.getElementById("stills").hidden = true;

async function startDrawing() {
  const stills = document.getElementById("stills"), why = await loadThree();
  if (why) {
    controls.hidden = true;
    panels.forEach(({canvas, bar, r}) => {
      canvas.replaceWith(...[stills.children[r]].filter(Boolean).map(each => each.cloneNode(true)));
      bar.parentElement.hidden = true;
    });
    grid.before($("p", {class: "soft", id: "still"}, `A picture that does not turn: ${why}`));
  }
  stills.remove();
}
async function loadThree() {  // why bodies cannot be turned, or nothing
  if (!data.three) return "the page was made without three.js (Debian's package libjs-three).";
  for (const panel of panels) {
    const options = {antialias: true, alpha: true};
    panel.context = panel.canvas.getContext("webgl2", options) || panel.canvas.getContext("webgl", options);
    if (!panel.context) return "this browser has no WebGL.";
  }
  const script = $("script");
  script.textContent = new TextDecoder().decode(await unpack(data.three));
  document.head.append(script);
  for (const group of groups.values()) startGroup(group);
  panels.forEach(startPanel);
  turning = true;
}
function startGroup(group) {  // one camera for its runs; lengths are parts of the bodies' size
  group.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.01, 4 * FAR_AWAY);
  group.camera.up.set(0, 0, 1);
  group.target = new THREE.Vector3();
  group.plane = new THREE.Plane(new THREE.Vector3(0, 0, 1), 0);
  group.shades = new THREE.DataTexture(new Uint8Array(4 * SHADES), SHADES, 1, THREE.RGBAFormat);
  group.panels = panels.filter(panel => panel.run.group === group);
}
function startPanel(panel) {
  const {canvas, context, run} = panel, {group} = run;
  panel.renderer = new THREE.WebGLRenderer({canvas, context, alpha: true});
  panel.renderer.localClippingEnabled = true;
  panel.scene = new THREE.Scene();
  panel.caster = new THREE.Raycaster();
  panel.axes = canvas.parentElement.appendChild(svg("svg", {class: "axes", viewBox: "-40 -40 80 80"}));
  const turn = panel.turn = new THREE.OrbitControls(group.camera, canvas);
  Object.assign(turn, {target: group.target, enableKeys: false, screenSpacePanning: true});
  turn.addEventListener("change", () => group.panels.forEach(render));
}
function startBodies(panel) {  // when their meshes are there
  const {run, scene} = panel;
  panel.bodies = run.bodies.map((body, b) => {
    const count = body.drawn.length, geometry = new THREE.BufferGeometry(), at = new Uint8Array(3 * count);
    for (let i = 0; i < count; i++) at[3 * i + i % 3] = 1;
    const attribute = (name, array, size) =>
        geometry.setAttribute(name, new THREE.BufferAttribute(array, size));
    attribute("position", new Float32Array(3 * count), 3);
    attribute("value", new Float32Array(count), 1);
    attribute("at", at, 3);
    attribute("sides", body.sharp, 3);
    geometry.addGroup(0, body.contactFrom, 0);
    geometry.addGroup(body.contactFrom, count - body.contactFrom, 1);
    const kinds = [material(run.group, b), material(run.group, b)];
    const solid = new THREE.Mesh(geometry, kinds);
    const cut = new THREE.Mesh(new THREE.BufferGeometry(), kinds[0].clone());
    const lines = [false, true].map(dashed => new THREE.LineSegments(
        new THREE.BufferGeometry(),
        dashed ? new THREE.LineDashedMaterial({color: 0x8a8a92, dashSize: 0.015, gapSize: 0.012})
               : new THREE.LineBasicMaterial({transparent: true, opacity: 0.55})));
    for (const each of [solid, cut, ...lines]) { each.frustumCulled = false; scene.add(each); }
    lines.forEach(each => { each.renderOrder = 2; });
    return {body, b, solid, cut, edges: lines[0], ghost: lines[1]};
  });
}
function material(group, b) {
  const grey = b % 2 ? 0.7 : 0.85;
  return new THREE.ShaderMaterial({
    vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.DoubleSide, clipping: true,
    extensions: {derivatives: true}, uniforms: {
      colours: {value: group.shades}, low: {value: 0}, high: {value: 1}, ratio: {value: 1}, mesh: {value: 1},
      plain: {value: new THREE.Vector3(grey, grey, grey)}, glass: {value: false}
    }
  });
}

// ---- What is seen: lengths from the middle of the bodies, as parts of their size --------------------------
function boxOf(group, scale) {  // of the bodies that are shown
  const box = new THREE.Box3();
  for (const run of group.runs) run.bodies.forEach((body, b) => {
    if (now.hidden.has(body.name)) return;
    const low = [], high = [];
    placed(run, stepOf(run), b, scale).forEach(values => {
      low.push(values.reduce((x, y) => Math.min(x, y)));
      high.push(values.reduce((x, y) => Math.max(x, y)));
    });
    box.expandByPoint(new THREE.Vector3(...low)).expandByPoint(new THREE.Vector3(...high));
  });
  return box;
}
function everything(group) {
  if (!turning) return {};
  if (!group.size) {
    const box = boxOf(group, 0), size = box.getSize(new THREE.Vector3());
    group.size = Math.max(size.x, size.y, size.z);
    group.middle = box.getCenter(new THREE.Vector3());
  }
  show([]);
  lookFrom(group, START);
  fit(group, boxOf(group, now.scale));
  return group;
}
const inScene = (group, point) => point.clone().sub(group.middle).divideScalar(group.size);
function lookFrom(group, [azimuth, elevation]) {
  const up = Math.PI / 180 * Math.max(-89.999, Math.min(89.999, elevation)), about = Math.PI / 180 * azimuth;
  group.camera.position.set(Math.cos(up) * Math.cos(about), Math.cos(up) * Math.sin(about), Math.sin(up))
      .multiplyScalar(FAR_AWAY).add(group.target);
  group.camera.lookAt(group.target);
  group.camera.updateMatrixWorld();
}
function anglesOf({camera, target}) {
  const {x, y, z} = camera.position.clone().sub(target).normalize();
  return [Math.atan2(y, x), Math.asin(Math.max(-1, Math.min(1, z)))].map(each => each * 180 / Math.PI);
}
function fit(group, box) {  // the box fills the picture, seen from where the eye is
  const angles = anglesOf(group), {camera} = group, {x, y} = extentSeen(group, box);
  group.target.copy(inScene(group, box.getCenter(new THREE.Vector3())));
  lookFrom(group, angles);
  camera.zoom = 0.9 / Math.max(y, x / aspectOf(group.panels[0]), 1e-9);
  camera.updateProjectionMatrix();
}
function extentSeen(group, {min, max}) {  // half of it, to the right and upwards
  const half = max.clone().sub(min).divideScalar(2 * group.size), e = group.camera.matrixWorld.elements;
  const along = k => [0, 1, 2].reduce((sum, c) => sum + Math.abs(e[4 * k + c]) * half.getComponent(c), 0);
  return {x: along(0), y: along(1)};
}
function aspectOf({canvas}) {
  const width = canvas.clientWidth || 1;
  canvas.style.height = `${Math.round(Math.min(0.8 * width, 0.6 * window.innerHeight))}px`;
  return width / (canvas.clientHeight || 1);
}
function seen(group, name) {  // a view by its name
  const {angles, hidden, body} = group.runs[0].views[name];
  show(hidden);
  lookFrom(group, angles);
  fit(group, body ? boxOfContact(group, body) : boxOf(group, now.scale));
}
function show(hidden) {  // all bodies but these
  now.hidden = new Set(hidden);
  bodyBoxes.forEach(each => { each.checked = !now.hidden.has(each.value); });
}
function boxOfContact({runs, size}, name) {  // about what is closed, if anything is
  const box = new THREE.Box3();
  for (const run of runs) {
    const b = run.bodies.findIndex(body => body.name === name), step = stepOf(run);
    const pressure = nodalValues(run, step, b, "pressure"), places = placed(run, step, b, now.scale);
    const closed = pressure.some(p => p > 0);
    pressure.forEach((p, i) => {
      if (closed ? p > 0 : p === p) box.expandByPoint(new THREE.Vector3(...places.map(of => of[i])));
    });
  }
  return box.expandByScalar(NEAR_CONTACT * Math.max(LEAST_CONTACT * size, box.max.distanceTo(box.min)));
}
function render(panel) {
  const {renderer, scene, canvas, run: {group}} = panel, aspect = aspectOf(panel), ratio = pixelRatio();
  if (renderer.getPixelRatio() !== ratio) renderer.setPixelRatio(ratio);
  if (panel.shape !== `${canvas.clientWidth} ${canvas.clientHeight}`) {
    renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
    panel.shape = `${canvas.clientWidth} ${canvas.clientHeight}`;
  }
  Object.assign(group.camera, {left: -aspect, right: aspect, top: 1, bottom: -1});
  group.camera.updateProjectionMatrix();
  renderer.render(scene, group.camera);
  drawAxes(panel);
  canvas.dataset.view = [...anglesOf(group), group.camera.zoom].map(each => each.toFixed(3));
}
const pixelRatio = () => Math.min(window.devicePixelRatio || 1, 2);
function drawAxes({axes, run: {group}}) {
  const e = group.camera.matrixWorldInverse.elements;
  axes.replaceChildren(...["x", "y", "z"].flatMap((name, c) => {
    const [x, y] = [26 * e[4 * c], -26 * e[4 * c + 1]];
    return [svg("path", {class: "axis", d: `M0 0L${x.toFixed(1)} ${y.toFixed(1)}`}),
            svg("text", {x: (1.35 * x).toFixed(1), y: (1.35 * y + 4).toFixed(1), "text-anchor": "middle"},
                name)];
  }));
}

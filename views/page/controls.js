// ---- The page ---------------------------------------------------------------------------------------------
const page = document.getElementById("page"), now = {
  field: "von_mises",
  step: 0,
  scale: 1,
  wide: true,
  mesh: true,
  ghost: true
};
const longest = runs.reduce((a, b) => b.steps.length > a.steps.length ? b : a);
const stepOf = run => {  // that of the run nearest in time
  const t = longest.steps[now.step].time;
  let best = 0;
  run.steps.forEach((each, i) => {
    if (Math.abs(each.time - t) < Math.abs(run.steps[best].time - t)) best = i;
  });
  return best;
};
page.append($("h1", {}, [...new Set(runs.map(run => run.title))].join(", ")));
for (const run of runs) {
  if (run.failed) page.append($("p", {class: "bad"}, `${run.name} stopped early: ${run.failed}`));
  if (run.steps.length < run.keptSteps)
    page.append(
        $("p", {class: "soft"},
          `${run.name}: ${run.steps.length} of ${run.keptSteps} kept steps are in this page.`));
}

const asked = runs.flatMap(run => run.asked.map(row => [run.name, ...row]));  // what the scene asks for
const askedBox = $("div", {class: "charts", id: "asked"});
if (asked.length) {
  const heads = ["run", "quantity", "value", "unit", "at", "smallest", "largest", "error"],
        shown = heads.map((_, i) => asked.some(row => row[i] !== "") && (i > 0 || runs.length > 1)),
        row = (tag, cells) => $("tr", {}, ...cells.flatMap((cell, i) => shown[i] ? [$(tag, {}, cell)] : []));
  page.append(
      $("div", {class: "wide"},
        $("table", {id: "quantities"}, row("th", heads), ...asked.map(cells => row("td", cells)))));
}
page.append(askedBox);

function control(words, element, output) {
  controls.append($("label", {}, words, element, ...(output ? [output] : [])));
  return element;
}
const controls = page.appendChild($("div", {class: "controls"}));
const common = runs[0].fields.filter(field => runs.every(run => fieldOf(run, field.name)));
const fieldMenu = control(
    "field",
    $("select", {id: "field"},
      ...common.map(field => $("option", {value: field.name}, withUnit(field.words, field.unit)))));
const stepOutput = $("output", {for: "step"}), scaleOutput = $("output", {for: "scale"});
const stepSlider = control(
    "step", $("input", {type: "range", id: "step", min: 0, max: longest.steps.length - 1, step: 1}),
    stepOutput);
now.step = longest.steps.length - 1;
stepSlider.value = now.step;
stepSlider.disabled = longest.steps.length < 2;
const natural = Math.min(...runs.map(run => run.scale));
const scales = [...new Set([
                 0, 1, natural,
                 ...[0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].map(
                     f => Number((f * natural).toPrecision(2)))
               ])].sort((a, b) => a - b);
const scaleSlider = control(
    "deformation x", $("input", {type: "range", id: "scale", min: 0, max: scales.length - 1, step: 1}),
    scaleOutput);
scaleSlider.value = scales.indexOf(natural);
const box = (id, words, checked) => {
  const element = $("input", {type: "checkbox", id});
  element.checked = checked;
  return control(words, element);
};
const meshBox = box("mesh", "meshes", true), ghostBox = box("ghost", "undeformed", true),
      wideBox = box("wide", "fix colour range", false);
const whole = controls.appendChild($("button", {type: "button", id: "whole"}, "reset view"));

const grid = page.appendChild($("div", {class: "runs"}));
const panels = runs.map((run, r) => {
  const canvas = $("canvas", {
    id: `canvas${r}`,
    tabindex: 0,
    role: "img",
    "aria-label": `Deformed bodies of ${run.name}. Arrow keys move, plus and minus zoom, 0 shows everything.`
  });
  const read = $("p", {class: "read", id: `read${r}`, "aria-live": "polite"}),
        bar = $("canvas", {width: 256, height: 1}), legend = $("div"), scale = $("div", {class: "scale"});
  const contact = $("div", {class: "contact"});
  grid.append(
      $("section", {class: "run"}, $("h3", {}, $("i", {class: `dot b${r % 4}`}), run.name),
        $("div", {class: "picture"}, canvas), $("div", {class: "bar"}, legend, bar, scale), read, contact));
  return {run, r, canvas, read, bar, legend, scale, contact, context: canvas.getContext("2d")};
});

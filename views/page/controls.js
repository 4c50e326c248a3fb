// ---- The page ---------------------------------------------------------------------------------------------
const page = document.getElementById("page");
const now = {
  field: runs[0].fields[0].name, step: 0, scale: 1, wide: false, mesh: true, ghost: true, raw: false,
  bands: false, ranges: {}  // of a field: ends that were set
};
const nearest = (run, t) => run.steps.reduce(
    (best, each, i) => Math.abs(each.time - t) < Math.abs(run.steps[best].time - t) ? i : best, 0);
const longest = runs.reduce((a, b) => b.steps.length > a.steps.length ? b : a);
// All panels show one time: the slider stops where every run has a step; if there is no such time but one, at
// the steps of the longest run, beside which others show their nearest.
const all = longest.steps.map(each => each.time), close = 1e-6 * Math.max(...all.map(Math.abs));
const shared = all.filter(
    t => runs.every(run => Math.abs(run.steps[nearest(run, t)].time - t) <= close));
const times = shared.length > 1 || all.length === 1 ? shared.length ? shared : all : all;
const timeNow = () => times[now.step];
const stepOf = run => nearest(run, timeNow());

const head = page.appendChild($("h1", {}, [...new Set(runs.map(run => run.title))].join(", ")));
for (const run of runs) {
  if (run.failed) page.append($("p", {class: "bad"}, `${run.name} stopped early: ${run.failed}`));
  if (run.steps.length < run.keptSteps)
    page.append(
        $("p", {class: "soft"},
          `${run.name}: ${run.steps.length} of ${run.keptSteps} kept steps are in this page.`));
}
const key = () => $(
    "p", {class: "key"},
    ...runs.map((run, r) => $("span", {}, $("i", {class: `b${r % 4}`}), run.name)));
if (runs.length > 1) page.append(key());
function table(attributes, heads, rows) {
  const row = (tag, cells) => $(
      "tr", {}, ...cells.map((cell, i) => $(tag, {"data-head": heads[i] || ""}, cell)));
  const body = rows.map(cells => row("td", cells));
  return $("div", {class: "wide"}, $("table", attributes, row("th", heads), ...body));
}
const quantities = runs.flatMap(run => run.quantities.map(row => [run.name, ...row]));
const askedBox = $("div", {class: "charts", id: "asked"});
if (quantities.length) {
  const heads = ["run", "quantity", "value", "unit", "at", "smallest", "largest", "error"],
        used = heads.map((_, i) => i > 0 ? quantities.some(row => row[i] !== "") : runs.length > 1),
        chosen = cells => cells.filter((_, i) => used[i]);
  page.append(table({id: "quantities"}, chosen(heads), quantities.map(chosen)));
}
page.append(askedBox);

function control(words, element, output) {
  controls.append($("label", {}, words, element, ...(output ? [output] : [])));
  return element;
}
const controls = page.appendChild($("div", {class: "controls"}));
const stepOutput = $("output", {for: "step"}), scaleOutput = $("output", {for: "scale"});
const stepSlider = control(
    "time", $("input", {type: "range", id: "step", min: 0, max: times.length - 1, step: 1}), stepOutput);
now.step = times.length - 1;
stepSlider.value = now.step;
stepSlider.disabled = times.length < 2;
const common = runs[0].fields.filter(field => runs.every(run => fieldOf(run, field.name)));
const fieldMenu = control(
    "field",
    $("select", {id: "field"},
      ...common.map(field => $("option", {value: field.name}, withUnit(field.words, field.unit)))));
const choice = (id, words, options) => control(
    words, $("select", {id}, ...options.map(([value, each]) => $("option", {value}, each))));
const valuesMenu = choice("values", "values", [["recovered", "recovered"], ["raw", "of the triangles"]]);
const coloursMenu = choice("colours", "colours", [["smooth", "smooth"], ["bands", "bands"]]);
const lowBox = control("from", $("input", {type: "number", id: "low", step: "any"})),
      highBox = control("to", $("input", {type: "number", id: "high", step: "any"}));
const natural = Math.min(...runs.map(run => run.scale));
const others = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].map(
    f => Number((f * natural).toPrecision(2)));
const scales = [...new Set([0, 1, natural, ...others])].sort((a, b) => a - b);
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
      wideBox = box("wide", "one range for all times", false);
const whole = controls.appendChild($("button", {type: "button", id: "whole"}, "reset view"));

const contactBox = $("div", {class: "charts", id: "contact"});
page.append($("section", {}, $("h2", {}, "Contact ", $("span", {class: "soft when"})), contactBox, $(
    "p", {class: "soft"},
    "Band: from the contact pressure to the normal stress that is recovered in the nonmortar body; its " +
    "width estimates the error. Gap: marks are the weighted gaps of the nodes, lines the distance between " +
    "the deformed meshes.")));
const bodiesHead = page.appendChild($("h2", {}, "Bodies ", $("span", {class: "soft when"})));
const grid = page.appendChild($("div", {class: "runs"}));
if (data.space) head.after(controls, bodiesHead, grid);
const panels = runs.map((run, r) => {
  const canvas = $("canvas", {
    id: `canvas${r}`,
    tabindex: 0,
    role: "img",
    "aria-label": `Deformed bodies of ${run.name}. Arrow keys ${
        data.space ? "turn" : "move"}, plus and minus zoom, 0 shows everything.`
  });
  const read = $("p", {class: "read", id: `read${r}`, "aria-live": "polite"}),
        time = $("span", {class: "soft"}), bar = $("canvas", {width: SHADES, height: 1}),
        legend = $("div"), scale = $("div", {class: "scale"}),
        most = $("p", {class: "most", id: `most${r}`});
  grid.append(
      $("section", {class: "run"}, $("h3", {}, $("i", {class: `dot b${r % 4}`}), `${run.name} `, time),
        $("div", {class: data.space ? "picture space" : "picture"}, canvas),
        $("div", {class: "bar"}, legend, bar, scale), most, read));
  return {run, r, canvas, read, bar, legend, scale, most, time};
});

// ---- Everything together ----------------------------------------------------------------------------------
let waiting = null;
function redraw() {  // once a frame, when the data of the step are there
  if (waiting) return waiting;
  grid.setAttribute("aria-busy", "true");
  return waiting = (async () => {
    do {  // the slider may have moved on
      await Promise.all(runs.map(run => loadStep(run, stepOf(run))));
      await new Promise(requestAnimationFrame);
    } while (runs.some(run => !run.steps[stepOf(run)].fields));
    waiting = null;
    for (const group of groups.values()) {
      if (group.fit) { group.view = everything(group); group.fit = false; }
      group.range = colourRange(group);
    }
    const {automatic} = panels[0].run.group.range;
    lowBox.placeholder = short(automatic.low, 4);
    highBox.placeholder = short(automatic.high, 4);
    for (const panel of panels) {
      paint(panel, panel.run.group.range);
      if (panel.last) hover(panel, ...panel.last); else hover(panel, -1, -1);
    }
    grid.removeAttribute("aria-busy");
  })();
}
async function change(event) {
  const ends = now.ranges[fieldMenu.value] || {};
  if (event && [lowBox, highBox].includes(event.target)) {
    const end = event.target === lowBox ? "low" : "high", value = event.target.valueAsNumber;
    now.ranges[fieldMenu.value] = {...ends, [end]: Number.isFinite(value) ? value : undefined};
  } else {
    lowBox.value = ends.low ?? "";
    highBox.value = ends.high ?? "";
  }
  Object.assign(now, {
    field: fieldMenu.value,
    step: Number(stepSlider.value),
    scale: scales[Number(scaleSlider.value)],
    wide: wideBox.checked,
    mesh: meshBox.checked,
    ghost: ghostBox.checked,
    raw: valuesMenu.value === "raw",
    bands: coloursMenu.value === "bands"
  });
  valuesMenu.disabled = !recoverable(now.field);
  const words = `t = ${short(timeNow(), 6)} ${longest.units.time}`.trim();
  stepOutput.textContent = words;
  stepSlider.setAttribute("aria-valuetext", words);
  document.querySelectorAll(".when").forEach(each => { each.textContent = words; });
  for (const {run, time} of panels) {
    const {step, time: t} = run.steps[stepOf(run)], same = Math.abs(t - timeNow()) <= close;
    time.textContent = same ? `step ${step}` : `step ${step}, t = ${short(t, 6)} ${run.units.time}`;
  }
  scaleOutput.textContent = String(now.scale);
  scaleSlider.setAttribute("aria-valuetext", String(now.scale));
  drawCharts();
  await redraw();
}
let drawnWidth = 0;
function drawCharts() {
  drawnWidth = page.clientWidth;
  drawContact();
  drawHistories();
}
for (const element of [fieldMenu, valuesMenu, coloursMenu, lowBox, highBox, stepSlider, scaleSlider, wideBox,
                       meshBox, ghostBox])
  element.addEventListener("input", change);
whole.addEventListener("click", () => showAll(...groups.values()));
new ResizeObserver(() => {
  if (page.clientWidth !== drawnWidth) drawCharts();
  if (runs[0].group.view) redraw();
}).observe(grid);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => redraw());

const historyBox = $("div", {class: "charts", id: "histories"});
page.append($("h2", {}, "Histories"), historyBox);
for (const run of runs)
  if (run.history.every > 1)
    page.append(
        $("p", {class: "soft"}, `${run.name}: every ${run.history.every}th row of history.csv is drawn.`));
for (const title of new Set(runs.flatMap(run => Object.keys(run.tables)))) {
  const names = [...new Set(runs.flatMap(run => (run.tables[title] || []).map(([name]) => name)))];
  const value = (run, name) => ((run.tables[title] || []).find(each => each[0] === name) || ["", ""])[1];
  page.append(
      $("h2", {}, title),
      table({}, ["", ...runs.map(run => run.name)], names.map(name => [
        name, ...runs.map(run => value(run, name))
      ])));
}
for (const title of new Set(runs.flatMap(run => Object.keys(run.grids)))) {
  page.append($("h2", {}, title));
  for (const run of runs.filter(each => each.grids[title])) {
    const [heads, ...rows] = run.grids[title];
    if (runs.length > 1) page.append($("h3", {}, run.name));
    page.append(table({}, heads, rows));
  }
}
page.append($("h2", {}, "What was modelled and left out"));
for (const run of runs) {
  if (!run.plan) {
    page.append(
        $("p", {class: "soft"}, `${run.name}: not known: the scene is not where it was, or not as it was.`));
    continue;
  }
  const rows = run.plan.map(([modelled, ...words]) => [modelled ? "modelled" : "left out", ...words]);
  page.append($("details", {}, $("summary", {}, run.name), table({}, ["", "part", "what", "why"], rows)));
}
page.append($("h2", {}, "Scene"));
for (const run of runs)
  page.append(
      $("details", {}, $("summary", {}, `${run.name}: ${run.path}`),
        ...(run.settings.length ? [$("p", {}, `changed by --set: ${run.settings.join("; ")}`)] : []),
        $("pre", {class: "scene"}, run.scene === null ? "not kept in this result" : run.scene)));

await Promise.all([startDrawing(), ...runs.flatMap(run => run.bodies.map(loadMesh))]);
await change();
document.documentElement.dataset.ready = String(Math.round(performance.now()));
for (const run of runs)  // the others, before one asks for them
  for (let i = run.steps.length - 1; i >= 0; i--) await loadStep(run, i);

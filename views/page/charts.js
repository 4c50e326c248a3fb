// ---- Charts -----------------------------------------------------------------------------------------------
// As wide as their place is, so that letters have one size.
function ticks(low, high, count = 5) {
  const raw = (high - low) / count, unit = 10 ** Math.floor(Math.log10(raw)),
        step = [1, 2, 5, 10].find(f => f * unit >= raw * (1 - 1e-9)) * unit, found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) found.push(i * step);
  return found;
}
const GAP = 12;
function widthIn(box) {
  const all = box.clientWidth || 400, columns = Math.max(1, Math.floor((all + GAP) / (330 + GAP)));
  return Math.floor(Math.min(540, (all - GAP * (columns - 1)) / columns));
}
function below(x, y) {  // the part of a line below zero
  const points = [];
  x.forEach((each, i) => {
    if (i && (y[i] < 0) !== (y[i - 1] < 0))
      points.push([x[i - 1] + (each - x[i - 1]) * y[i - 1] / (y[i - 1] - y[i]), 0]);
    points.push([each, Math.min(0, y[i])]);
  });
  return points;
}
function extent(values, small) {  // of an axis, with a margin
  let low = Math.min(...values), high = Math.max(...values);
  const rounding = Math.max(small, 1e-9 * Math.max(Math.abs(low), Math.abs(high)));
  if (high - low <= rounding) {
    const margin = small || 0.1 * Math.abs(high) || 1;
    low -= margin;
    high += margin;
  }
  const pad = 0.06 * (high - low);
  return [low - pad, high + pad];
}
// series: {x, y, to, run, marks, line, fill, name}; to: the other end of a band
function chart(box, {title, xWords, series, small = 0, now: at, id}) {
  const W = widthIn(box), H = 230, R = 12, T = 26, B = 40;
  const xs = series.flatMap(s => [Math.min(...s.x), Math.max(...s.x)]);
  const ys = series.flatMap(s => [s.y, s.to || s.y].flatMap(y => [Math.min(...y), Math.max(...y)]));
  let [x0, x1] = [Math.min(...xs), Math.max(...xs)];
  if (!(x1 > x0)) { x0 -= 0.5; x1 += 0.5; }
  const [y0, y1] = extent(ys, small), marks = ticks(y0, y1, 4);
  const L = 22 + 7 * Math.max(...marks.map(y => short(y, 5).length));
  const X = x => L + (x - x0) / (x1 - x0) * (W - L - R), Y = y => H - B - (y - y0) / (y1 - y0) * (H - T - B),
        n = v => v.toFixed(1);
  const element = svg("svg", {
              width: W, height: H, viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": title,
              ...(id ? {id} : {})
            }),
        label = svg("text", {x: 2, y: 14, class: "title"});
  label.textContent = title;
  element.append(label);
  for (const y of marks)
    element.append(
        svg("path", {class: "grid", d: `M${L} ${n(Y(y))}H${W - R}`}),
        svg("text", {x: L - 6, y: n(Y(y) + 4), "text-anchor": "end"}, short(y, 5)));
  for (const x of ticks(x0, x1, 5))
    element.append(
        svg("path", {class: "grid", d: `M${n(X(x))} ${T}V${H - B}`}),
        svg("text", {x: n(X(x)), y: H - B + 15, "text-anchor": X(x) > W - 20 ? "end" : "middle"},
            short(x, 5)));
  element.append(svg("text", {x: (L + W - R) / 2, y: H - 6, "text-anchor": "middle"}, xWords));
  if (y0 < 0 && y1 > 0) element.append(svg("path", {class: "zero", d: `M${L} ${n(Y(0))}H${W - R}`}));
  if (at !== undefined) element.append(svg("path", {class: "now", d: `M${n(X(at))} ${T}V${H - B}`}));
  const polygon = (points, run) => {
    const places = points.map(([x, y]) => `${n(X(x))} ${n(Y(y))}`);
    return svg("path", {class: `under f${run % 4}`, d: `M${places.join("L")}Z`});
  };
  for (const s of series) {
    const points = Array.from(s.x, (x, i) => `${n(X(x))} ${n(Y(s.y[i]))}`);
    if (s.fill) element.append(polygon([[s.x[0], 0], ...below(s.x, s.y), [s.x[s.x.length - 1], 0]], s.run));
    if (s.to) {
      const there = Array.from(s.x, (x, i) => [x, s.y[i]]), back = Array.from(s.x, (x, i) => [x, s.to[i]]);
      element.append(polygon([...there, ...back.reverse()], s.run));
      continue;
    }
    if (s.line !== false && points.length > 1)
      element.append(svg("path", {class: `c${s.run % 4}`, d: "M" + points.join("L")}));
    if (s.marks || points.length === 1)
      Array.from(
          s.x,
          (x, i) => element.append(
              svg("circle", {class: `c${s.run % 4}`, cx: n(X(x)), cy: n(Y(s.y[i])), r: 2.6})));
  }
  element.addEventListener("pointermove", event => {
    const area = element.getBoundingClientRect(), px = event.clientX - area.left,
          py = event.clientY - area.top;
    let best = null, distance = 400;
    for (const s of series)
      for (let i = 0; i < s.x.length && !s.to; i++) {
        const d = (X(s.x[i]) - px) ** 2 + (Y(s.y[i]) - py) ** 2;
        if (d < distance) {
          distance = d;
          best = [s, i];
        }
      }
    label.textContent = best ? `${best[0].name}: ${short(best[0].x[best[1]], 6)}, ${best[0].y[best[1]]}`
                             : title;
  });
  element.addEventListener("pointerleave", () => { label.textContent = title; });
  return element;
}
const named = (run, words) => runs.length > 1 ? `${run.name}, ${words}` : words;
function drawContact() {  // all runs with the same bodies in one chart of each contact line
  contactBox.replaceChildren(...[...groups.values()].flatMap((group, g) => {
    const count = Math.max(...group.runs.map(run => run.lines.length));
    return Array.from({length: count}, (_, k) => k).flatMap(k => lineCharts(group, g, k));
  }));
  contactBox.parentElement.hidden = !contactBox.children.length;
}
function lineCharts(group, g, k) {
  const found = group.runs.filter(run => run.lines[k]).map(run => ({
    run, r: runs.indexOf(run), line: run.lines[k], at: run.lines[k].steps[stepOf(run)]
  }));
  const {line, run: {units}} = found[0], where = `${line.nonmortar} on ${line.mortar}`, id = `${g}-${k}`;
  const small = 1e-9 * Math.max(...found.map(each => each.line.length)),
        xWords = withUnit(line.name, units.length);
  const slipsOf = at => (at.slipping || []).flatMap((slip, i) => slip ? [i] : []);
  const charts = [chart(contactBox, {
    id: `pressure${id}`,
    title: `contact pressure [${units.stress}], ${where}`,
    xWords,
    series: found.flatMap(({run, r, line: {x}, at: {pressure, body}}) => [
      {x, y: pressure, to: body, run: r},
      {x, y: pressure, run: r, marks: true, name: named(run, "pressure")}
    ])
  })];
  if (found.some(each => each.at.shear)) charts.push(chart(contactBox, {
    id: `shear${id}`,
    title: `shear stress [${units.stress}], ${where}; marks: it slips`,
    xWords,
    series: found.filter(each => each.at.shear).flatMap(({run, r, line: {x}, at}) => [
      {x, y: at.shear, run: r, name: named(run, "sticks")},
      ...(slipsOf(at).length ? [{
        x: slipsOf(at).map(i => x[i]), y: slipsOf(at).map(i => at.shear[i]), run: r, marks: true, line: false,
        name: named(run, "slips")
      }] : [])
    ])
  }));
  charts.push(chart(contactBox, {
    id: `gap${id}`,
    title: `gap [${units.length}], ${where}`,
    xWords,
    small,
    series: found.flatMap(({run, r, line: {x}, at: {gap, jump}}) => jump
      ? [{x: jump[0], y: jump[1], run: r, name: named(run, "between nodes"),
          fill: Math.min(...jump[1]) < -small},
         {x, y: gap, run: r, marks: true, line: false, name: named(run, "at a node, weighted")}]
      : [{x, y: gap, run: r, marks: true, name: named(run, "gap"), fill: Math.min(...gap) < -small}])
  }));
  return charts;
}
function drawHistories() {
  const t = timeNow();
  const all = runs.flatMap((run, r) => run.history.columns.map(column => ({...column, run, r})));
  const charts = (box, asked) => [...new Set(all.filter(each => each.asked === asked).map(each => each.name))]
    .flatMap(name => {
      const series = all.filter(each => each.name === name && each.y.length > 1).map(each => ({
        x: each.run.history.time, y: each.y, run: each.r, name: named(each.run, each.words),
        marks: each.y.length < 25
      }));
      const {words, unit} = all.find(each => each.name === name);
      return series.some(s => s.y.some(v => v !== s.y[0]))
        ? [chart(box, {
            title: withUnit(words, unit), xWords: withUnit("time", runs[0].units.time), series, now: t
          })]
        : [];
    });
  const paths = runs.flatMap((run, r) => {
    const [x, y] = (run.history.path || []).map(name => run.history.columns.find(each => each.name === name));
    return x && y && x.y.length > 1 && y.y.some(v => v !== y.y[0])
      ? [{x: [0, ...x.y], y: [0, ...y.y], run: r, name: run.name, marks: y.y.length < 25, of: [x, y]}]
      : [];
  });
  askedBox.replaceChildren(...charts(askedBox, true), ...(paths.length ? [chart(askedBox, {
    id: "force-displacement",
    title: `${withUnit(paths[0].of[1].words, paths[0].of[1].unit)} over displacement`,
    xWords: withUnit(paths[0].of[0].words, paths[0].of[0].unit),
    series: paths
  })] : []));
  historyBox.replaceChildren(...charts(historyBox, false));
}

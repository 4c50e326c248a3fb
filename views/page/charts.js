// ---- Charts -----------------------------------------------------------------------------------------------
function ticks(low, high, count = 5) {
  const raw = (high - low) / count, unit = 10 ** Math.floor(Math.log10(raw)),
        step = [1, 2, 5, 10].find(f => f * unit >= raw) * unit, found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) found.push(i * step);
  return found;
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
function chart({
  title,
  xWords,
  series,
  small = 0,
  now: at,
  id,
  also = []
}) {  // series: {x, y, run, marks, line, fill, name}
  const W = 460, H = 210, L = 62, R = 12, T = 24, B = 36;
  const xs = series.flatMap(s => [Math.min(...s.x), Math.max(...s.x)]),
        ys = [...also, ...series.flatMap(s => [Math.min(...s.y), Math.max(...s.y)])];
  let [x0, x1] = [Math.min(...xs), Math.max(...xs)], [y0, y1] = [Math.min(...ys), Math.max(...ys)];
  if (!(x1 > x0)) { x0 -= 0.5; x1 += 0.5; }
  if (y1 - y0 <= small) { const middle = (y0 + y1) / 2; y0 = middle - small; y1 = middle + small; }
  if (y1 - y0 <= 1e-9 * Math.max(Math.abs(y0), Math.abs(y1)) || y1 === y0) {
    const margin = 0.1 * Math.abs(y1) || 1;
    y0 -= margin;
    y1 += margin;
  }
  const pad = 0.06 * (y1 - y0); y0 -= pad; y1 += pad;
  const X = x => L + (x - x0) / (x1 - x0) * (W - L - R), Y = y => H - B - (y - y0) / (y1 - y0) * (H - T - B),
        n = v => v.toFixed(1);
  const element = svg(
            "svg", {viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": title, ...(id ? {id} : {})}),
        label = svg("text", {x: L, y: 14});
  label.textContent = title;
  element.append(label);
  for (const y of ticks(y0, y1, 4))
    element.append(
        svg("path", {class: "grid", d: `M${L} ${n(Y(y))}H${W - R}`}),
        svg("text", {x: L - 5, y: n(Y(y) + 4), "text-anchor": "end"}, short(y, 5)));
  for (const x of ticks(x0, x1, 5))
    element.append(
        svg("path", {class: "grid", d: `M${n(X(x))} ${T}V${H - B}`}),
        svg("text", {x: n(X(x)), y: H - B + 14, "text-anchor": "middle"}, short(x, 5)));
  element.append(svg("text", {x: (L + W - R) / 2, y: H - 5, "text-anchor": "middle"}, xWords));
  if (y0 < 0 && y1 > 0) element.append(svg("path", {class: "zero", d: `M${L} ${n(Y(0))}H${W - R}`}));
  if (at !== undefined) element.append(svg("path", {class: "now", d: `M${n(X(at))} ${T}V${H - B}`}));
  for (const s of series) {
    const points = Array.from(s.x, (x, i) => `${n(X(x))} ${n(Y(s.y[i]))}`);
    if (s.fill)
      element.append(svg("path", {
        class: `under f${s.run % 4}`,
        d: `M${n(X(s.x[0]))} ${n(Y(0))}L${
            below(s.x, s.y).map(([x, y]) => `${n(X(x))} ${n(Y(y))}`).join("L")}L${
            n(X(s.x[s.x.length - 1]))} ${n(Y(0))}Z`
      }));
    if (s.line !== false && points.length > 1)
      element.append(svg("path", {class: `c${s.run % 4}`, d: "M" + points.join("L")}));
    if (s.marks || points.length === 1)
      Array.from(
          s.x,
          (x, i) => element.append(
              svg("circle", {class: `c${s.run % 4}`, cx: n(X(x)), cy: n(Y(s.y[i])), r: 2.6})));
  }
  element.addEventListener("pointermove", event => {
    const area = element.getBoundingClientRect(), px = (event.clientX - area.left) / area.width * W,
          py = (event.clientY - area.top) / area.height * H;
    let best = null, distance = 400;
    for (const s of series)
      for (let i = 0; i < s.x.length; i++) {
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
function drawContact(panel) {
  const {run, r} = panel, step = stepOf(run);
  panel.contact.replaceChildren(...run.lines.flatMap((line, k) => {
    const {pressure, gap, jump, shear, slipping} = line.steps[step],
                          slips = (slipping || []).flatMap((slip, i) => slip ? [i] : []),
                          small = 1e-9 * line.length,
                          xWords = withUnit(line.name, run.units.length),
                          where = `${line.nonmortar} on ${line.mortar}`;
    const others = run.group.runs.flatMap(
        each => each.lines[k] ? [each.lines[k].steps[stepOf(each)]] : []);  // on one scale with this run
    const range = name => others.flatMap(
        each => each[name] ? [Math.min(...each[name]), Math.max(...each[name])] : []);
    const drawn = jump
      ? [{x: jump[0], y: jump[1], run: r, fill: Math.min(...jump[1]) < -small, name: "gap between the nodes"},
         {x: line.x, y: gap, run: r, marks: true, line: false, name: "gap of a node"}]
      : [{x: line.x, y: gap, run: r, marks: true, name: "gap of a node", fill: Math.min(...gap) < -small}];
    const jumps = others.flatMap(
        each => each.jump ? [Math.min(...each.jump[1]), Math.max(...each.jump[1])] : []);
    return [
      chart({
        id: `pressure${r}-${k}`,
        title: `contact pressure, ${withUnit(where, run.units.stress)}`,
        xWords,
        also: range("pressure"),
        series: [{x: line.x, y: pressure, run: r, marks: true, name: "pressure"}]
      }),
      ...(shear ? [chart({
        id: `shear${r}-${k}`,
        title: `shear stress, ${withUnit(where, run.units.stress)}; marks: it slips`,
        xWords,
        also: range("shear"),
        series: [
          {x: line.x, y: shear, run: r, name: "sticks"},
          ...(slips.length
            ? [{x: slips.map(i => line.x[i]), y: slips.map(i => shear[i]), run: r, marks: true, line: false,
                name: "slips"}]
            : [])
        ]
      })]
                : []),
      chart({
        id: `gap${r}-${k}`,
        title: `gap, ${withUnit(where, run.units.length)}; line geometric, markers weighted`,
        xWords,
        small,
        also: [...range("gap"), ...jumps],
        series: drawn
      })
    ];
  }));
}
const historyBox = $("div", {class: "charts", id: "histories"});
const leftOut = new Set(
    ["step", "time", "rejections", "guarded", "factorisations", "joined", "left", "sign", "estimate"]);
function drawHistories() {
  const t = longest.steps[now.step].time,
        names = [...new Set(runs.flatMap(run => Object.keys(run.history.columns)))];
  const bare = name => name.split("[")[0],
        wanted = new Set(runs.flatMap(run => run.asked.map(each => each[0])));
  const drawn = names.filter(name => !leftOut.has(bare(name)));
  const charts = chosen => drawn.filter(name => chosen(bare(name))).flatMap(name => {
    const series = runs.flatMap((run, r) => {
      const columns = run.history.columns,
            time = columns[Object.keys(columns).find(each => each.startsWith("time["))], y = columns[name];
      return y && time && y.length > 1 ? [{x: time, y, run: r, name: run.name, marks: y.length < 25}] : [];
    });
    return series.some(s => s.y.some(v => v !== s.y[0])) ? [chart({
      title: name.replaceAll("_", " ").replace("[", " ["),
      xWords: withUnit("time", runs[0].units.time),
      series,
      now: t
    })]
                                                         : [];
  });
  const force = names.find(name => bare(name) === "contact_force"),
        moved = names.find(name => bare(name) === "displacement_max");
  const paths = runs.flatMap((run, r) => {
    const x = run.history.columns[moved], y = run.history.columns[force];
    return x && y && x.length > 1 && y.some(v => v !== y[0])
      ? [{x: [0, ...x], y: [0, ...y], run: r, name: run.name, marks: y.length < 25}]
      : [];
  });
  askedBox.replaceChildren(...charts(name => wanted.has(name)), ...(paths.length ? [chart({
    id: "force-displacement",
    title: force.replace("_", " ").replace("[", " [") + " over the largest displacement",
    xWords: moved.replace("displacement_max", "largest displacement ").trim(),
    series: paths
  })] : []));
  historyBox.replaceChildren(...charts(name => !wanted.has(name)));
}

// ---- Colours ----------------------------------------------------------------------------------------------
const SHADES = 1024, BANDS = 10;
const tables = Object.fromEntries(Object.entries(data.colours).map(([name, stops]) => {
  const rgb = stops.map(stop => [0, 2, 4].map(i => parseInt(stop.slice(i, i + 2), 16)));
  return [name, Uint32Array.from({length: SHADES}, (_, i) => {
    const at = i / (SHADES - 1) * (rgb.length - 1), k = Math.min(Math.floor(at), rgb.length - 2), f = at - k;
    const [red, green, blue] = rgb[k].map((each, c) => Math.round(each + f * (rgb[k + 1][c] - each)));
    return (255 << 24 | blue << 16 | green << 8 | red) >>> 0;
  })];
}));
const banded = table => table.map((_, i) => {
  const band = Math.floor(i / SHADES * BANDS);
  return table[Math.round(band / (BANDS - 1) * (SHADES - 1))];
});
function colourRange({runs}) {  // one for all runs of a group; a corner must not take all the colours
  const signed = fieldOf(runs[0], now.field).signed;
  const found = runs.flatMap(
      run => (now.wide ? run.ranges : [run.ranges[stepOf(run)]]).map(each => each[now.field]));
  const least = Math.min(...found.map(each => each[0])), most = Math.max(...found.map(each => each[1]));
  let low = least, high = most;
  const top = Math.max(...found.map(each => each[2])), size = Math.max(Math.abs(low), Math.abs(high));
  if (signed) { high = top < 0.7 * size && top > 0 ? top : size; low = -high; }
  else {
    if (top < 0.7 * high && top > 0) high = top;
    if (high - low > 0.5 * Math.abs(high)) low = Math.min(0, low);
  }
  if (!(high - low > 1e-9 * size)) { const margin = 0.1 * size || 1; low -= margin; high += margin; }
  const chosen = now.ranges[now.field] || {}, automatic = {low, high};
  if (chosen.low !== undefined) low = chosen.low;
  if (chosen.high !== undefined) high = chosen.high;
  if (!(high > low)) { low = automatic.low; high = automatic.high; }
  const {contact} = fieldOf(runs[0], now.field);
  const table = tables[signed ? "signed" : contact ? "contact" : "plain"], slight = 1e-6 * (high - low);
  return {
    low, high, automatic, signed, below: least < low - slight, above: most > high + slight,
    table: now.bands ? banded(table) : table
  };
}

// Runs with bodies of the same names are seen alike: one part of the plane, its centre and half width, and
// one scale of colours.
const groups = new Map();
for (const run of runs) {
  const names = run.bodies.map(body => body.name).join();
  if (!groups.has(names)) groups.set(names, {runs: [], view: null, fit: true});  // fit: everything, next time
  groups.get(names).runs.push(run);
  run.group = groups.get(names);
}
const WAYS = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
const pointIn = (canvas, event) => {  // in CSS pixels
  const area = canvas.getBoundingClientRect();
  return [event.clientX - area.left, event.clientY - area.top];
};
const showAll = (...all) => { all.forEach(group => { group.fit = true; }); redraw(); };
const recoverable = name => /^[se]\d\d$|^von_mises$/.test(name);
function drawLegend(panel, range) {
  const strip = panel.bar.getContext("2d"), shades = strip.createImageData(SHADES, 1);
  new Uint32Array(shades.data.buffer).set(range.table);
  strip.putImageData(shades, 0, 0);
  const field = fieldOf(panel.run, now.field),
        kind = now.raw || !recoverable(field.name) ? "" : ", recovered at the vertices";
  panel.legend.textContent = withUnit(field.words, field.unit) + kind;
  const marks = now.bands ? Array.from({length: BANDS / 2 + 1}, (_, i) => range.low + 2 * i / BANDS *
                                (range.high - range.low))
                          : ticks(range.low, range.high, 5);
  panel.scale.replaceChildren(...marks.map((value, i) => {
    const part = 100 * (value - range.low) / (range.high - range.low), mark = $("span"),
          words = short(value, now.bands ? 3 : 5);
    mark.textContent = i === marks.length - 1 && range.above ? `${words} \u2192`
        : i === 0 && range.below                             ? `\u2190 ${words}`
                                                             : words;
    mark.style.left = `${part}%`;
    mark.style.transform = `translateX(${part < 8 ? 0 : part > 92 ? -100 : -50}%)`;
    return mark;
  }));
}
function extremes(bodies) {  // the largest of their numbers, and the smallest: value, body, index
  const found = [null, null];
  bodies.forEach((values, b) => values.forEach((value, i) => {
    if (!(value <= found[0]?.value) && value === value) found[0] = {value, b, i};
    if (!(value >= found[1]?.value) && value === value) found[1] = {value, b, i};
  }));
  return found;
}
function tellExtremes({run, most: box}, range, [most, least], placeOf, where = "") {  // gives what it tells
  const field = fieldOf(run, now.field);
  const told = most && !["viscoplastic", "region"].includes(field.name) &&
      most.value - least.value > 1e-9 * Math.max(Math.abs(most.value), Math.abs(least.value));
  const ends = !told ? [] : range.signed ? [most, least] : [most];
  const words = ends.map((each, k) => `${k ? "smallest" : "largest"} ${
      of(short(each.value, 4), field.unit)} in ${run.bodies[each.b].name} at (${
      placeOf(each).map(x => short(x, 4)).join(", ")})`);
  box.textContent = told ? words.join("; ") + where : "";
  return ends;
}

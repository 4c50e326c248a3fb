// Search in the site: the index is a script beside this one, loaded when the field is used first; pages that
// are opened as files cannot fetch.
"use strict";
(() => {
  const root = document.currentScript.dataset.root, most = 12;
  const make = (tag, attributes, ...children) => {
    const element = Object.assign(document.createElement(tag), attributes);
    element.append(...children);
    return element;
  };
  const field = make("input", {type: "search", id: "search", placeholder: "search", autocomplete: "off"}),
        found = make("div", {id: "found"});
  field.setAttribute("aria-label", "search in these pages");
  found.setAttribute("role", "status");
  document.querySelector("header").append(field, found);
  let loading = null;
  const index = () => loading ??= new Promise(done => {
    const onload = () => done(window.searchIndex);
    document.head.append(make("script", {src: `${root}/search-index.js`, onload}));
  });
  const folded = text => text.toLowerCase();
  function matches(sections, text) {  // all words, wherever they stand; those of a heading count most
    const words = folded(text).split(/\s+/).filter(Boolean);
    if (!words.length) return [];
    return sections
        .map(([page, anchor, title, body]) => {
          const head = folded(title), rest = folded(body);
          if (!words.every(word => head.includes(word) || rest.includes(word))) return null;
          const score = words.reduce((sum, word) => sum + (head.includes(word) ? 10 : 0) +
              Math.min(5, rest.split(word).length - 1) * 1500 / (rest.length + 1500), 0);
          return {page, anchor, title, body, score, words};
        })
        .filter(Boolean)
        .sort((a, b) => b.score - a.score)
        .slice(0, most);
  }
  function excerpt({body, words}) {
    const places = words.map(word => folded(body).indexOf(word)).filter(i => i >= 0);
    const at = Math.max(0, Math.min(...places) - 60);
    const text = Number.isFinite(at) ? body.slice(at, at + 160) : body.slice(0, 160), parts = [];
    let from = 0;
    const low = folded(text);
    while (from < text.length) {  // the words that were looked for stand out
      const next = words.map(word => [low.indexOf(word, from), word.length]).filter(([i]) => i >= 0)
                       .sort((a, b) => a[0] - b[0])[0];
      if (!next) break;
      parts.push(text.slice(from, next[0]), make("mark", {}, text.slice(next[0], next[0] + next[1])));
      from = next[0] + next[1];
    }
    return make("p", {}, ...parts, text.slice(from));
  }
  async function search() {
    const text = field.value, sections = await index();
    if (text !== field.value) return;
    const hits = matches(sections, text);
    found.replaceChildren(...hits.map(hit => make(
        "a", {href: `${root}/${hit.page}${hit.anchor && "#" + hit.anchor}`}, hit.title, excerpt(hit))));
    if (text.trim() && !hits.length) found.textContent = "nothing found";
  }
  field.addEventListener("focus", index);
  field.addEventListener("input", search);
  const close = () => { found.replaceChildren(); };
  document.addEventListener("keydown", event => {
    const links = [...found.querySelectorAll("a")], at = links.indexOf(document.activeElement);
    if (event.key === "/" && !/^(INPUT|TEXTAREA|SELECT)$/.test(document.activeElement.tagName)) field.focus();
    else if (event.key === "Escape") close();
    else if (event.key === "Enter" && document.activeElement === field && links.length) links[0].click();
    else if (event.key === "ArrowDown" && links.length && (at >= 0 || document.activeElement === field))
      links[Math.min(at + 1, links.length - 1)].focus();
    else if (event.key === "ArrowUp" && at >= 0) (links[at - 1] || field).focus();
    else return;
    event.preventDefault();
  });
  found.addEventListener("click", event => { if (event.target.closest("a")) setTimeout(close); });
})();

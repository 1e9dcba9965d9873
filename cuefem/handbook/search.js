"use strict";
// Search in the handbook: lists each section, from a heading to the next, that contains all words; runs offline.
{
  const field = document.getElementById("search"), hits = document.getElementById("hits");
  const count = document.getElementById("count"), contents = document.getElementById("contents");
  const parts = [...document.querySelectorAll("main section > [id]")].map((head) => {
    let text = "";
    for (let next = head.nextElementSibling; next && !next.id; next = next.nextElementSibling) text += " " + next.textContent;
    const chapter = head.parentElement.querySelector("h1");
    const title = head === chapter ? head.textContent : `${chapter.textContent}: ${head.textContent}`;
    text = text.replace(/\s+/g, " ").trim();
    return { id: head.id, title, text, heading: title.toLowerCase(), lower: `${title} ${text}`.toLowerCase() };
  });
  const around = (part, word) => {
    const at = Math.max(part.text.toLowerCase().indexOf(word), 0), from = Math.max(at - 40, 0);
    return (from ? "…" : "") + part.text.slice(from, at + 80) + (part.text.length > at + 80 ? "…" : "");
  };
  const show = () => {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    const matches = words.length ? parts.filter((part) => words.every((word) => part.lower.includes(word))) : [];
    const rank = (part) => words.filter((word) => part.heading.includes(word)).length;
    matches.sort((a, b) => rank(b) - rank(a));
    hits.replaceChildren(...matches.slice(0, 12).map((part) => {
      const link = Object.assign(document.createElement("a"), { href: `#${part.id}`, textContent: part.title });
      const item = document.createElement("li"), excerpt = document.createElement("span");
      excerpt.textContent = around(part, words[0]);
      item.append(link, excerpt);
      return item;
    }));
    const more = matches.length > 12 ? ", the first 12 here" : "";
    count.textContent = words.length ? (matches.length ? `${matches.length} section${matches.length > 1 ? "s" : ""}${more}` : "not found") : "";
    contents.hidden = words.length > 0;
  };
  field.addEventListener("input", show);
  field.addEventListener("keydown", (event) => {
    const first = hits.querySelector("a");
    if (event.key === "Escape") { field.value = ""; show(); }
    if (event.key === "Enter" && first) { first.click(); event.preventDefault(); }
    if (event.key === "ArrowDown" && first) { first.focus(); event.preventDefault(); }
  });
  hits.addEventListener("keydown", (event) => {
    const links = [...hits.querySelectorAll("a")], at = links.indexOf(document.activeElement);
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step || at < 0) return;
    (links[at + step] || (step < 0 ? field : links[at])).focus();
    event.preventDefault();
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "/" && document.activeElement !== field) { field.focus(); event.preventDefault(); }
  });
}

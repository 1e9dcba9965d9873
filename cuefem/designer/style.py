"""The designer's own styles, beside those of the report's page, and its few lines of script: it plays a tone, and puts
the role and value of a slider on the part of it that takes the keys, where a screen reader looks for them."""

STYLE = """
body { max-width: 1440px; --q-primary: var(--c1) !important; }
.desk svg.chart text { font-size: 13px; } .desk .grid2 .wide svg text { font-size: 11px; }
.nicegui-content, .q-page { display: block; padding: 0; min-height: 0 !important; }
.nicegui-html, .markup { min-width: 0; width: 100%; }
.q-layout { min-height: 0 !important; }
.desk { display: grid; grid-template-columns: minmax(280px, 320px) minmax(0, 1fr); gap: 1.1rem; align-items: start; }
.desk > * { min-width: 0; }
.desk section { margin: 0 0 1.1rem; }
.knobs { position: sticky; top: 0.6rem; max-height: calc(100vh - 1.2rem); overflow-y: auto; --more: rgb(0 0 0 / 0.22);
  background:  /* shadows at the ends that have more beyond them: the covers of the first line move with the knobs */
    linear-gradient(var(--card), var(--card)) 0 0 / 100% 1.6rem local no-repeat,
    linear-gradient(var(--card), var(--card)) 0 100% / 100% 1.6rem local no-repeat,
    linear-gradient(var(--more), transparent) 0 0 / 100% 1.2rem no-repeat,
    linear-gradient(transparent, var(--more)) 0 100% / 100% 1.2rem no-repeat, var(--card); }
@media (prefers-color-scheme: dark) { .knobs { --more: rgb(255 255 255 / 0.2); } }
sub { line-height: 0; }
h1, h2 { font-weight: 700; letter-spacing: 0; font-family: inherit; } h2 { line-height: 1.3; }
.desk .grid2 { grid-template-columns: repeat(auto-fit, minmax(min(100%, 340px), 1fr)); }
.rest th.text { white-space: normal; min-width: 9rem; } .rest td { vertical-align: top; }
.knob { margin: 0 0 0.15rem; }
.knob .line { display: flex; justify-content: space-between; align-items: center; gap: 0.4rem; font-size: 0.88rem;
  line-height: 1.2; }
.knob .line > :first-child { flex: 1; width: auto; }
.knobs h3 { margin: 0.8rem 0 0.3rem; font-size: 0.95rem; font-weight: 650; line-height: 1.3; }
.sheet table { width: 100%; } .sheet td { padding: 0.15rem 0.25rem 0.15rem 0; min-width: 5rem; }
.sheet .row, .sheet .cells { display: flex; flex-wrap: wrap; gap: 0.4rem; align-items: end; margin: 0 0 0.5rem; }
.sheet .cell { width: min(9.4rem, calc(50% - 0.4rem)); } .sheet .cell.broad { width: 11rem; }
.sheet .q-field__label { font-size: 0.95rem; }
.sheet .card { border: 1px solid var(--rule); border-radius: 8px; padding: 0.5rem 0.7rem; margin: 0 0 0.5rem; }
.sheet h3 { margin: 0 0 0.3rem; font-size: 0.9rem; font-weight: 650; line-height: 1.3; }
.sheet .markup { width: auto; } .menu-item { color: var(--ink); max-width: 34rem; }
.menu-item small { display: block; color: var(--soft); white-space: normal; }
.hint { font-size: 0.8rem; line-height: 1.3; }
.knob .q-field { width: 6.2rem; flex: none; } .knob .q-field:has([aria-label*="mrad"]) { width: 9rem; }
.knob .q-field__control, .knob .q-field__marginal { height: 1.7rem !important; min-height: 0 !important; }
.knob .q-field__native { padding: 0; text-align: right; font-variant-numeric: tabular-nums; color: var(--ink); }
.knob .q-field__suffix, .knob .q-field__append { padding: 0 0 0 0.3rem; color: var(--soft); line-height: 1.7rem; }
.knob .q-slider { height: 24px; padding: 0 8px; }
.q-slider * { transition: none !important; }  /* else all is laid out anew in every frame after a move */
.q-slider, .q-btn.q-btn--outline { color: var(--c1) !important; }
.q-slider__track { background: var(--rule); }
.choice { width: 100%; margin-bottom: 0.5rem; }
.choice .q-field__native, .choice .q-field__label, .q-menu { color: var(--ink) !important; }
.choice .q-field__label { color: var(--soft) !important; }
.q-menu { background: var(--card) !important; }
.actions { display: flex; flex-wrap: wrap; gap: 0.5rem; margin: 0.7rem 0 1rem; }
.actions .q-btn { text-transform: none; }
.said { position: fixed; left: 50%; bottom: 1rem; transform: translateX(-50%); z-index: 10; width: max-content;
  margin: 0; max-width: min(70ch, calc(100vw - 2rem)); padding: 0.6rem 0.9rem;
  border: 1px solid var(--c2); border-left-width: 5px;
  border-radius: 6px; color: var(--ink); background: var(--card); box-shadow: 0 4px 18px rgb(0 0 0 / 0.25); }
.key-strip { background: var(--card); }
.advice td { vertical-align: middle; } .advice td:first-child { width: 1px; }
.advice td:nth-child(2) { white-space: normal; min-width: 8rem; }
.key-strip .key { grid-template-columns: repeat(auto-fit, minmax(118px, 1fr)); }
.key-strip .key dd { font-size: 1.25rem; white-space: nowrap; } .key-strip .key small { white-space: normal; }
.key b { font-weight: 650; }
.miscue { color: var(--c2); }
.stale { opacity: 0.4; } b.stale { opacity: 1; animation: pale 0.2s 0.35s forwards; }
@keyframes pale { to { opacity: 0.4; } }
.markup.stale { transition: opacity 0.2s 0.4s; }
.tones { display: flex; flex-wrap: wrap; gap: 0.4rem; max-width: none; }
.tone { font: inherit; font-size: 0.86rem; color: var(--ink); background: var(--paper); border: 1px solid var(--soft);
  border-radius: 6px; padding: 0.25rem 0.6rem; cursor: pointer; font-variant-numeric: tabular-nums; }
.tone small { color: var(--soft); }
.tone:focus-visible, .q-btn:focus-visible, summary:focus-visible { outline: 3px solid var(--c2); outline-offset: 2px; }
.q-slider__track-container:focus-visible .q-slider__thumb { outline: 3px solid var(--c2);
  outline-offset: 2px; border-radius: 50%; }
.unseen { display: none; }
.spoken { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
.wrong { margin: 0 0 0.3rem; padding: 0.1rem 0.5rem; font-size: 0.82rem; line-height: 1.3; color: var(--ink);
  border-left: 4px solid var(--c2); background: var(--slip); }
.units { min-width: 6.5rem; } .units .q-field__native { color: var(--ink) !important; }
.units .q-field__control, .units .q-field__marginal { height: 2.1rem !important; min-height: 0 !important; }
.units .q-field__native { min-height: 0 !important; padding-bottom: 2px; }
.units .q-field__label { top: 7px; color: var(--soft); }
.q-field__native, .q-field__input { color: var(--ink); } .q-field__label { color: var(--soft); }
.dialog { background: var(--card); color: var(--ink); border: 1px solid var(--rule); border-radius: 10px;
  padding: 1.1rem 1.4rem; width: min(42rem, calc(100vw - 2rem)); max-width: none !important; }
.wide-field { width: 100%; } .dialog .q-btn .block { background: var(--card); }
.pins { display: grid; gap: 0.4rem; margin: 0 0 0.6rem; }
.pin { display: flex; flex-wrap: wrap; gap: 0.5rem; align-items: center; }
.pin .q-field { width: 15rem; max-width: 100%; }
.pin .markup { width: auto; } .pin .q-field__control { height: 2.1rem !important; }
td small { color: var(--soft); }
.miss { fill: var(--c2); opacity: 0.28; }
.under p { margin: 0.2rem 0; }
.q-btn.disabled { opacity: 0.55 !important; }
.trust details { margin: -0.3rem 0.4rem 1rem; font-size: 0.9rem; } .trust summary { display: list-item; }
@media print {
  .words, .actions, .knob .q-slider, .q-expansion-item--collapsed, .tones, .pins, .choice .q-field__append {
    display: none !important; }
  .q-layout, .q-page-container { display: block; } .desk { display: block; }
  .knobs { max-height: none; overflow: visible; columns: 3; position: static; break-inside: auto; }
  .knob .q-field, .knob .q-field:has([aria-label*="mrad"]) { width: 11rem; } .knobs h3 { break-after: avoid; }
  .knobs h2 { column-span: all; } .knob, .choice { break-inside: avoid; margin: 0; } .knob .line { line-height: 1.1; }
  .desk .grid2 { grid-template-columns: 1fr 1fr !important; } .desk section { margin: 0 0 0.6rem; }
  .desk svg.chart text { font-size: 11px; } .desk .grid2 .wide svg text { font-size: 9px; }
  .key-strip { position: static !important; }
}
@media screen and (max-width: 860px) {
  .desk { grid-template-columns: minmax(0, 1fr); }
  .knobs { position: static; max-height: none; order: 2; }
  .desk > .answers { display: contents; }
  .key-strip { order: 1; position: sticky; top: 0; z-index: 5; padding: 0.5rem 0.7rem; margin: 0 !important; }
  .key-strip .key { grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 0.3rem 0.6rem; }
  .key-strip .key dd { font-size: 1.02rem; }
  .key-strip .key dt, .key-strip .key small { font-size: 0.72rem; line-height: 1.2; }
  .rest { order: 3; } .rest th.text { min-width: 5.2rem; }
  .rest td:nth-child(4) { white-space: normal; min-width: 4.4rem; }
}
"""

SCRIPT = """
<script>
// What this browser keeps: the desk of this tab, and the last desk of all tabs; nothing of it leaves the computer.
window.cuefem = {
  kept(key) {
    const read = (store, name) => { try { return store().getItem(name) || ""; } catch { return ""; } };
    const kept = read(() => sessionStorage, key) || read(() => localStorage, key);
    return { kept, units: read(() => localStorage, "cuefem-units") };
  },
  keep(key, text) {
    for (const store of [() => sessionStorage, () => localStorage]) try { store().setItem(key, text); } catch {}
  },
  // What the page shows, without an update of its elements.
  part(id) { return document.getElementById("c" + id); },
  put(id, markup) { const part = this.part(id); if (part) part.innerHTML = markup; },
  pale(id, stale) { this.part(id)?.classList.toggle("stale", stale); },
  busy(busy) { document.querySelector(".answers").ariaBusy = busy; },
  remember(units) { try { localStorage.setItem("cuefem-units", units); } catch {} },
};
// A dropped file goes where a chosen one does.
Object.assign(window.cuefem, {
  sends(address) { this.address = address; },
  send(file) {
    const form = new FormData();
    form.append("file", file, file.name);
    return fetch(this.address, { method: "POST", body: form });
  },
});
addEventListener("dragover", event => event.preventDefault());
addEventListener("drop", event => {
  if (!event.dataTransfer?.files.length) return;
  event.preventDefault();
  window.cuefem.send(event.dataTransfer.files[0]);
});
addEventListener("hashchange", () => { if (location.hash.startsWith("#d=")) location.reload(); });
addEventListener("keydown", event => {
  if (!(event.ctrlKey || event.metaKey) || event.altKey || event.target.closest("input[type=text], textarea")) return;
  const key = event.key.toLowerCase(), redo = key === "y" || (key === "z" && event.shiftKey);
  if (key !== "z" && key !== "y") return;
  event.preventDefault();
  document.querySelector(redo ? "[data-redo]" : "[data-undo]").click();
});
document.addEventListener("click", event => {
  const button = event.target.closest(".tone");
  if (!button) return;
  const sound = window.cuefemSound ??= new AudioContext();
  const tone = sound.createOscillator(), loudness = sound.createGain(), now = sound.currentTime;
  tone.frequency.value = Number(button.dataset.hz);
  loudness.gain.setValueAtTime(0.0001, now);
  loudness.gain.exponentialRampToValueAtTime(0.4, now + 0.01);
  loudness.gain.exponentialRampToValueAtTime(0.0005, now + 1.5);
  tone.connect(loudness).connect(sound.destination);
  tone.start(now);
  tone.stop(now + 1.5);
});
const spoken = ["aria-label", "aria-valuemin", "aria-valuemax", "aria-valuenow", "aria-orientation"];
const speak = slider => {
  const inner = slider.querySelector(".q-slider__track-container");
  inner.setAttribute("role", "slider");
  for (const name of spoken) {
    if (!slider.hasAttribute(name)) continue;
    inner.setAttribute(name, slider.getAttribute(name));
    slider.removeAttribute(name);
  }
};
new MutationObserver(changes => {
  for (const { target, type, addedNodes } of changes) {
    if (type === "attributes") { if (target.matches(".q-slider")) speak(target); continue; }
    for (const node of addedNodes) if (node.querySelectorAll) node.querySelectorAll(".q-slider").forEach(speak);
  }
}).observe(document.body, { subtree: true, childList: true, attributeFilter: ["aria-valuenow", "aria-label"] });
</script>
"""

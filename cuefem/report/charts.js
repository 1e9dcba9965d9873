// Shows the values of a chart's curves at the pointer or, by the arrow keys, at round values of its x axis.
(() => {
  const added = (parent, kind, attributes) => {
    const element = parent.appendChild(document.createElementNS(parent.namespaceURI, kind));
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return element;
  };
  const numbers = text => text.split(" ").map(Number);
  const heightAt = (outline, x) => {
    for (const run of outline.split("M").slice(1)) {
      const points = run.split("L").map(numbers);
      for (let i = 1; i < points.length; i++) {
        const [a, b] = [points[i - 1], points[i]];
        if (a[0] !== b[0] && (x - a[0]) * (x - b[0]) <= 0) return a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
      }
    }
    return NaN;
  };
  const digits = step => Math.max(0, 2 - Math.floor(Math.log10(step) + 1e-9));
  const written = (value, step, more) => value.toFixed(Math.min(digits(step) - 2 + more, 9)).replace("-", "\u2212");
  const spoken = document.createElement("p");
  spoken.className = "spoken";
  spoken.setAttribute("aria-live", "polite");
  document.body.append(spoken);
  let seen = null;

  const away = () => {
    document.querySelectorAll(".reading").forEach(element => element.remove());
    seen = null;
  };
  const show = (chart, value) => {
    const [left, top, right, bottom] = numbers(chart.dataset.box);
    const [first, last, step] = numbers(chart.dataset.xScale), [low, high, yStep] = numbers(chart.dataset.yScale);
    value = Math.min(last, Math.max(first, value));
    const x = left + (value - first) / (last - first) * (right - left);
    away();
    seen = { chart, value };
    const group = added(chart, "g", { class: "reading" });
    added(group, "path", { class: "cursor", d: `M${x} ${top}V${bottom}` });
    const box = document.createElement("div"), head = box.appendChild(document.createElement("b"));
    box.className = "reading";
    head.textContent = `${chart.dataset.xLabel}: ${written(value, step, 2)}`;
    for (const curve of chart.querySelectorAll(".curve")) {
      const y = heightAt(curve.getAttribute("d"), x);
      if (!(y >= top - 1 && y <= bottom + 1)) continue;
      const style = [...curve.classList].filter(name => name !== "curve").join(" ");
      added(group, "circle", { class: `dot ${style}`, cx: x, cy: y, r: 3.2 });
      const line = box.appendChild(document.createElement("span"));
      const name = line.appendChild(document.createElement("i"));
      name.className = `name ${style}`;
      name.textContent = curve.textContent;
      line.append(` ${written(low + (bottom - y) / (bottom - top) * (high - low), yStep, 2)}`);
    }
    const figure = chart.closest("figure"), frame = chart.getBoundingClientRect();
    const over = figure.getBoundingClientRect(), unit = frame.width / 440;
    box.style.top = `${frame.top - over.top + (top + 4) * unit}px`;
    if (x < (left + right) / 2) box.style.left = `${frame.left - over.left + (x + 8) * unit}px`;
    else box.style.right = `${over.right - frame.left - (x - 8) * unit}px`;
    figure.append(box);
  };
  const follow = event => {
    const chart = event.target.closest?.("svg.read");
    if (!chart) return void (seen && document.activeElement !== seen.chart && away());
    const [left, , right] = numbers(chart.dataset.box), [first, last] = numbers(chart.dataset.xScale);
    const frame = chart.getBoundingClientRect(), x = (event.clientX - frame.left) * 440 / frame.width;
    if (x < left - 6 || x > right + 6) return away();
    show(chart, first + (x - left) / (right - left) * (last - first));
  };
  addEventListener("pointermove", follow);
  addEventListener("pointerdown", follow);
  addEventListener("focusout", away);
  addEventListener("keydown", event => {
    const chart = event.target.closest?.("svg.read");
    if (!chart) return;
    if (event.key === "Escape") return away();
    const [first, last, step] = numbers(chart.dataset.xScale), fine = step / 10;
    const was = seen?.chart === chart ? seen.value : (first + last) / 2;
    const by = { ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10 }[event.key];
    const to = { Home: first, End: last }[event.key] ?? (by && fine * Math.round(was / fine + by));
    if (to === undefined) return;
    event.preventDefault();
    show(chart, to);
    spoken.textContent = [...document.querySelector("div.reading").children].map(part => part.textContent).join("; ");
  });
  addEventListener("beforeprint", () => {
    away();
    for (const fold of document.querySelectorAll("details:not([open])")) { fold.open = true; fold.dataset.shut = ""; }
  });
  addEventListener("afterprint", () => {
    for (const fold of document.querySelectorAll("details[data-shut]")) {
      fold.open = false;
      delete fold.dataset.shut;
    }
  });
})();

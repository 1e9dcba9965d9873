// Shows the values of a chart's curves at the pointer or, by the arrow keys, at round values of its x axis.
(() => {
  const append = (parent, kind, attributes) => {
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
  const formatted = (value, step, more) => value.toFixed(Math.min(digits(step) - 2 + more, 9)).replace("-", "\u2212");
  const spoken = document.createElement("p");
  spoken.className = "spoken";
  spoken.setAttribute("aria-live", "polite");
  document.body.append(spoken);
  let current = null;

  const hide = () => {
    document.querySelectorAll(".reading").forEach(element => element.remove());
    current = null;
  };
  const show = (chart, value) => {
    const [left, top, right, bottom] = numbers(chart.dataset.box);
    const [first, last, step] = numbers(chart.dataset.xScale), [low, high, yStep] = numbers(chart.dataset.yScale);
    value = Math.min(last, Math.max(first, value));
    const x = left + (value - first) / (last - first) * (right - left);
    hide();
    current = { chart, value };
    const group = append(chart, "g", { class: "reading" });
    append(group, "path", { class: "cursor", d: `M${x} ${top}V${bottom}` });
    const box = document.createElement("div"), head = box.appendChild(document.createElement("b"));
    box.className = "reading";
    head.textContent = `${chart.dataset.xLabel}: ${formatted(value, step, 2)}`;
    for (const curve of chart.querySelectorAll(".curve")) {
      const y = heightAt(curve.getAttribute("d"), x);
      if (!(y >= top - 1 && y <= bottom + 1)) continue;
      const style = [...curve.classList].filter(name => name !== "curve").join(" ");
      append(group, "circle", { class: `dot ${style}`, cx: x, cy: y, r: 3.2 });
      const line = box.appendChild(document.createElement("span"));
      const name = line.appendChild(document.createElement("i"));
      name.className = `name ${style}`;
      name.textContent = curve.textContent;
      line.append(` ${formatted(low + (bottom - y) / (bottom - top) * (high - low), yStep, 2)}`);
    }
    const figure = chart.closest("figure"), frame = chart.getBoundingClientRect();
    const over = figure.getBoundingClientRect(), unit = frame.width / 440;
    box.style.top = `${frame.top - over.top + (top + 4) * unit}px`;
    if (x < (left + right) / 2) box.style.left = `${frame.left - over.left + (x + 8) * unit}px`;
    else box.style.right = `${over.right - frame.left - (x - 8) * unit}px`;
    figure.append(box);
  };
  const onPointer = event => {
    const chart = event.target.closest?.("svg.read");
    if (!chart) return void (current && document.activeElement !== current.chart && hide());
    const [left, , right] = numbers(chart.dataset.box), [first, last] = numbers(chart.dataset.xScale);
    const frame = chart.getBoundingClientRect(), x = (event.clientX - frame.left) * 440 / frame.width;
    if (x < left - 6 || x > right + 6) return hide();
    show(chart, first + (x - left) / (right - left) * (last - first));
  };
  addEventListener("pointermove", onPointer);
  addEventListener("pointerdown", onPointer);
  addEventListener("focusout", hide);
  addEventListener("keydown", event => {
    const chart = event.target.closest?.("svg.read");
    if (!chart) return;
    if (event.key === "Escape") return hide();
    const [first, last, step] = numbers(chart.dataset.xScale), fine = step / 10;
    const was = current?.chart === chart ? current.value : (first + last) / 2;
    const by = { ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10 }[event.key];
    const to = { Home: first, End: last }[event.key] ?? (by && fine * Math.round(was / fine + by));
    if (to === undefined) return;
    event.preventDefault();
    show(chart, to);
    spoken.textContent = [...document.querySelector("div.reading").children].map(part => part.textContent).join("; ");
  });
  addEventListener("beforeprint", () => {
    hide();
    for (const fold of document.querySelectorAll("details:not([open]):not(.engineers, .engineers *)")) { fold.open = true; fold.dataset.shut = ""; }
  });
  addEventListener("afterprint", () => {
    for (const fold of document.querySelectorAll("details[data-shut]")) {
      fold.open = false;
      delete fold.dataset.shut;
    }
  });
})();

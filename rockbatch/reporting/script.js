"use strict";
document.documentElement.classList.add("js");

// Tables: sort by any column, search
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const heads = [...table.tHead.rows[table.tHead.rows.length - 1].cells];

  // Numbers by value, ranges by their end, words by alphabet, nothing last; rows that tie stay in their order
  const number = (text) =>
    Number(text.replaceAll(",", "").replace("∞", "Infinity").replace(/^[≥≤]\s*/, "").split(" of ")[0].split("\u00a0–\u00a0").pop());
  const compare = (a, b) => {
    if (a === b) return 0;
    if (a === "" || b === "") return a === "" ? 2 : -2;
    const x = number(a), y = number(b);
    if (Number.isNaN(x) || Number.isNaN(y)) return a.localeCompare(b, undefined, { numeric: true }) < 0 ? -1 : 1;
    return x === y ? 0 : x < y ? -1 : 1;
  };
  heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const sign = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
      const keyed = rows.map((row) => [row.cells[column].textContent.trim(), row]);
      keyed.sort(([a], [b]) => {
        const order = compare(a, b);
        return Math.abs(order) === 2 ? order : sign * order;
      });
      body.append(...keyed.map(([, row]) => row));
    });
  });

  // What is copied goes into a spreadsheet: the rows that are shown, in their order
  const copy = document.createElement("button");
  copy.type = "button";
  copy.className = "copy";
  copy.textContent = "Copy table";
  copy.addEventListener("click", () => {
    const lines = [heads, ...[...body.rows].filter((row) => !row.hidden).map((row) => [...row.cells])];
    const text = lines.map((cells) => cells.map((cell) => cell.textContent.trim().replace(/\s+/g, " ")).join("\t")).join("\n");
    copy.dataset.text = text;
    const done = () => { copy.textContent = "Copied"; setTimeout(() => { copy.textContent = "Copy table"; }, 2000); };
    const byHand = () => {
      const area = document.body.appendChild(document.createElement("textarea"));
      area.value = text;
      area.select();
      if (document.execCommand("copy")) done();
      area.remove();
    };
    if (navigator.clipboard) navigator.clipboard.writeText(text).then(done, byHand); else byHand();
  });
  const bar = document.createElement("div");
  const count = document.createElement("span");
  bar.className = "filter scripted";
  bar.append(copy);
  table.parentElement.before(bar);
  if (rows.length < 8) continue;
  count.className = "muted";
  count.setAttribute("aria-live", "polite");
  const labelled = (words, node) => {
    const label = document.createElement("label");
    label.append(words, node);
    bar.append(label);
    return node;
  };
  // By each column that has a few values, and by words
  const chosen = heads.flatMap((head, column) => {
    const values = [...new Set(rows.map((row) => row.cells[column].textContent.trim()))];
    if (!("filter" in head.dataset) || values.length < 2 || values.length > 60) return [];
    const select = labelled(head.textContent, document.createElement("select"));
    select.append(...["all", ...values].map((value, place) => new Option(value || "none", place ? value : "*")));
    return [[column, select]];
  });
  const input = labelled("Search", document.createElement("input"));
  input.type = "search";
  input.placeholder = "words in a row …";
  bar.append(count, copy);
  const filter = () => {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const row of rows) {
      const titles = [...row.querySelectorAll("[title]")].map((node) => node.title);
      const text = [row.textContent, ...titles].join(" ").toLowerCase();
      row.hidden = !words.every((word) => text.includes(word))
        || chosen.some(([column, { value }]) => value !== "*" && row.cells[column].textContent.trim() !== value);
      shown += row.hidden ? 0 : 1;
    }
    count.textContent = `${shown} of ${rows.length} rows`;
  };
  bar.addEventListener("input", filter);
  filter();
}

// Scorecards of many cases
for (const words of document.querySelectorAll(".legend.rest")) {
  const card = words.previousElementSibling.querySelector(".card");
  const button = document.createElement("button");
  button.type = "button";
  button.className = "copy";
  button.textContent = words.dataset.button;
  button.addEventListener("click", () => { card.classList.add("every"); words.remove(); });
  words.append(" ", button);
}

// Figures of peaks: entries of the legend hide what they stand for, rows are sorted and searched
for (const figure of document.querySelectorAll("figure.peaks")) {
  const grid = figure.querySelector(".dots");
  const rows = [...grid.querySelectorAll(".row")];
  const own = rows.filter((row) => !row.classList.contains("rest"));
  const words = (row) => row.querySelector(".of").textContent;
  const hide = () => own.forEach((row) => {
    const marks = [...row.querySelectorAll("[data-case], [data-status]")];
    const found = input.value.toLowerCase().split(/\s+/).every((word) => `${words(row)} ${row.firstChild.title}`.toLowerCase().includes(word));
    row.hidden = !found || (marks.length > 0 && marks.every((mark) => mark.classList.contains("off")));
  });
  for (const entry of figure.querySelectorAll(".key li[data-of]")) {
    entry.role = "button";
    entry.tabIndex = 0;
    entry.ariaPressed = "true";
    entry.title = "Hide or show";
    const toggle = () => {
      entry.ariaPressed = String(entry.ariaPressed !== "true");
      const marks = grid.querySelectorAll(`[data-${entry.dataset.of}="${CSS.escape(entry.dataset.value)}"]`);
      marks.forEach((mark) => mark.classList.toggle("off", entry.ariaPressed !== "true"));
      hide();
    };
    entry.addEventListener("click", toggle);
    entry.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") { event.preventDefault(); toggle(); }
    });
  }
  const input = document.createElement("input");
  if (own.length < 8) continue;
  const bar = document.createElement("div");
  bar.className = "filter scripted";
  const labelled = (text, node) => { const label = document.createElement("label"); label.append(text, node); bar.append(label); };
  const order = document.createElement("select");
  order.append(new Option("worst first", ""), new Option("peak ground acceleration", "pga"), new Option("name", "name"));
  labelled("Sort by", order);
  input.type = "search";
  input.placeholder = "event, station …";
  labelled("Search", input);
  const all = () => { grid.classList.add("every"); more?.remove(); };
  const rest = grid.querySelector(".row.rest");
  let more = null;
  if (rest && own.length > rows.indexOf(rest)) {
    more = document.createElement("button");
    more.type = "button";
    more.className = "copy";
    more.textContent = `All ${own.length} records`;
    more.addEventListener("click", all);
    bar.append(more);
  }
  grid.before(bar);
  const last = rows[rows.length - 1].nextSibling;
  order.addEventListener("change", () => {
    all();
    const key = { "": (row) => own.indexOf(row), pga: (row) => -Number(row.dataset.pga ?? 0), name: words }[order.value];
    const sorted = own.map((row) => [key(row), row]).sort(([a], [b]) => (typeof a === "string" ? a.localeCompare(b, undefined, { numeric: true }) : a - b));
    sorted.forEach(([, row]) => grid.insertBefore(row, last));
  });
  input.addEventListener("input", () => { all(); hide(); });
}

// What is folded is unfolded by a link to it
const unfold = () => {
  const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  for (let fold = target.querySelector(":scope > details") ?? target.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
  target.scrollIntoView();
};
addEventListener("hashchange", unfold);
unfold();
for (const link of document.querySelectorAll('a[href^="#"]')) {
  link.addEventListener("click", () => { if (link.hash === location.hash) unfold(); });
}

// The list of sections marks the one that is read
const here = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    if (!isIntersecting) continue;
    document.querySelectorAll("nav a").forEach((link) => link.classList.toggle("here", link.hash === `#${target.id}`));
  }
}, { rootMargin: "-10% 0px -80% 0px" });
document.querySelectorAll("main > section").forEach((section) => here.observe(section));

// The note that follows the pointer, or the arrow keys
const tip = document.createElement("div");
tip.id = "tip";
tip.hidden = true;
tip.setAttribute("role", "status");
document.body.append(tip);
const say = (words, x, y) => {
  tip.textContent = words;
  tip.hidden = false;
  const room = document.documentElement.clientWidth - tip.offsetWidth - 8;
  tip.style.left = `${scrollX + Math.max(8, Math.min(x + 14, room))}px`;
  tip.style.top = `${scrollY + (y > tip.offsetHeight + 24 ? y - tip.offsetHeight - 14 : y + 24)}px`;
};
const hush = () => {
  tip.hidden = true;
  document.querySelectorAll(".cursor, .at").forEach((node) => node.remove());
};
addEventListener("keydown", (event) => { if (event.key === "Escape") hush(); });
// A finger that is lifted leaves its note; touching elsewhere takes it away
const left = (event) => { if (event.pointerType !== "touch") hush(); };
addEventListener("pointerdown", (event) => { if (!event.target.closest("svg.marks, svg.readings")) hush(); });

// Pictures of peaks: the mark nearest to the pointer says what it is
const marksOf = (node) => [...node.querySelectorAll("[data-says]")];
for (const title of document.querySelectorAll("svg.marks title")) {
  title.parentElement.dataset.says = title.textContent;
  title.remove(); // or the browser would show a second note
}
const point = (mark) => {
  const box = mark.getBoundingClientRect();
  const wide = box.width > 60;
  say(mark.dataset.says, wide ? box.left + 20 : box.right, box.top);
};
for (const svg of document.querySelectorAll("svg.marks")) {
  const nearest = (event) => {
    const away = (mark) => {
      const box = mark.getBoundingClientRect();
      const x = Math.max(box.left - event.clientX, event.clientX - box.right, 0);
      return Math.hypot(x, Math.max(box.top - event.clientY, event.clientY - box.bottom, 0));
    };
    const found = marksOf(svg).map((mark) => [away(mark), mark]).sort(([a], [b]) => a - b)[0];
    if (found && found[0] < 24) point(found[1]); else hush();
  };
  svg.addEventListener("pointermove", nearest);
  svg.addEventListener("pointerdown", nearest);
  svg.addEventListener("pointerleave", left);
}
for (const grid of document.querySelectorAll(".panels, .dots")) {
  let at = -1;
  grid.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    const marks = marksOf(grid);
    if (!step || !marks.length) return;
    event.preventDefault();
    at = (at + step + marks.length) % marks.length;
    marks[at].scrollIntoView({ block: "nearest" });
    const panel = marks[at].closest("[data-of]")?.dataset.of ?? marks[at].closest("figure").querySelector("figcaption").textContent;
    point(marks[at]);
    tip.textContent = `${panel}\n${tip.textContent}`;
  });
  grid.addEventListener("blur", hush);
}

// Histories and loops: values are read back from the curves as they are drawn
const made = (name, attributes) => {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  return node;
};
const pointsOf = (path) => {
  const points = [];
  const scale = path.transform.baseVal.consolidate().matrix.a;
  for (const piece of path.getAttribute("d").split("M").slice(1)) {
    const [start, steps = ""] = piece.split("l");
    let [x, y] = start.match(/-?\d+/g).map(Number);
    points.push([x * scale, y * scale]);
    const moves = (steps.match(/-?\d+/g) || []).map(Number);
    for (let i = 0; i < moves.length; i += 2) points.push([(x += moves[i]) * scale, (y += moves[i + 1]) * scale]);
  }
  return points;
};
const shown = (value, range) => value.toFixed(Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(range)))));
for (const svg of document.querySelectorAll("svg.readings")) {
  let all = null;
  const axes = () => (all ??= [...svg.querySelectorAll("g.axes")].map((group) => {
    const numbers = (key) => group.dataset[key].split(" ").map(Number);
    const [left, top, width, height] = numbers("box"), [x0, x1] = numbers("x"), [y0, y1] = numbers("y");
    return {
      group, left, top, width, height, kind: group.dataset.kind, names: (group.dataset.names ?? "|").split("|"), xRange: x1 - x0, yRange: y1 - y0,
      x: (px) => x0 + (px - left) / width * (x1 - x0), y: (py) => y1 - (py - top) / height * (y1 - y0),
      curves: [...group.querySelectorAll("path")].map((path) => ({ name: path.dataset.name, points: pointsOf(path) })),
    };
  }));
  const dot = (x, y) => made("path", { class: "at", d: `M${x} ${y}h0` }); // as a stroke it is round where curves are stretched
  let cursor = null; // px in the picture
  const readTime = (px, clientY) => {
    const timed = axes().filter((one) => one.kind === "time");
    const view = timed[0].group.ownerSVGElement.viewBox.baseVal;
    cursor = Math.max(view.x, Math.min(view.x + view.width, px));
    hush();
    const words = [`t = ${shown(timed[0].x(cursor), timed[0].xRange)} s`];
    for (const one of timed) {
      one.group.append(made("line", { class: "cursor", x1: cursor, x2: cursor, y1: one.top, y2: one.top + one.height }));
      for (const { name, points } of one.curves) {
        const after = points.findIndex(([x]) => x >= cursor);
        if (after < 0) continue;
        const [b, a] = [points[after], points[Math.max(0, after - 1)]];
        const y = b[0] === a[0] ? b[1] : a[1] + (cursor - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
        one.group.append(dot(cursor, y));
        words.push(`${name} = ${shown(one.y(y), one.yRange)}`);
      }
    }
    const at = new DOMPoint(cursor, timed[0].top).matrixTransform(timed[0].group.getScreenCTM()); // in the window
    say(words.join("\n"), at.x, clientY ?? at.y);
  };
  const readPlane = (one, [x, y]) => {
    hush();
    one.group.append(dot(x, y));
    const [across, down] = one.names;
    const at = new DOMPoint(x, y).matrixTransform(one.group.getScreenCTM());
    say(`${across} = ${shown(one.x(x), one.xRange)}\n${down} = ${shown(one.y(y), one.yRange)}`, at.x, at.y);
  };
  const nearest = (one, px, py) => one.curves.flatMap((curve) => curve.points)
    .reduce((best, p) => Math.hypot(p[0] - px, p[1] - py) < Math.hypot(best[0] - px, best[1] - py) ? p : best);
  const read = (event) => {
    for (const one of axes()) {
      const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(one.group.getScreenCTM().inverse());
      if (x < one.left - 2 || x > one.left + one.width + 2 || y < one.top || y > one.top + one.height) continue;
      if (one.kind === "time") readTime(x, event.clientY); else readPlane(one, nearest(one, x, y));
      return;
    }
    hush();
  };
  svg.tabIndex = 0;
  svg.addEventListener("pointermove", read);
  svg.addEventListener("pointerdown", read);
  svg.addEventListener("pointerleave", left);
  svg.addEventListener("blur", hush);
  svg.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const stride = step * (event.shiftKey ? 10 : 1);
    if (axes()[0].kind === "time") {
      readTime((cursor ?? axes()[0].group.ownerSVGElement.viewBox.baseVal.x) + stride);
    } else { // along the loops, one after the other
      const points = axes().flatMap((one) => one.curves.flatMap((curve) => curve.points.map((p) => [one, p])));
      cursor = ((cursor ?? -1) + stride + points.length) % points.length;
      readPlane(...points[cursor]);
    }
  });
}

// Histories: one motion at a time, the stretch in which the pier moves or the whole record
for (const pictures of document.querySelectorAll(".histories")) {
  const figures = [...pictures.children], timed = [...pictures.querySelectorAll("div.timed")];
  const choice = document.createElement("div");
  choice.className = "choice scripted";
  const control = (node, ...words) => {
    const label = document.createElement("label");
    label.append(...words);
    choice.append(label);
    return node;
  };
  if (figures.length > 1) {
    pictures.classList.add("several");
    const select = document.createElement("select");
    for (const figure of figures) select.add(new Option(figure.querySelector("strong").textContent));
    control(select, "Motion, the worst first ", select).addEventListener("change", () => {
      hush();
      figures.forEach((figure, i) => figure.classList.toggle("chosen", i === select.selectedIndex));
    });
  }
  if (pictures.querySelector("[data-views]")) {
    const box = document.createElement("input");
    box.type = "checkbox";
    control(box, box, " whole record").addEventListener("change", () => {
      hush();
      for (const picture of timed) {
        picture.classList.toggle("whole", box.checked);
        for (const panel of picture.querySelectorAll("[data-views]")) {
          panel.setAttribute("viewBox", panel.dataset.views.split("|")[Number(box.checked)]);
        }
      }
    });
  }
  if (choice.firstChild) pictures.before(choice);
}

// The worst run of each case: the pier follows the curves of its history, in one clock with the ground
for (const player of document.querySelectorAll(".player")) {
  const figures = [...player.children], histories = [...document.querySelectorAll(".histories > figure")];
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  const node = (name, attributes = {}, ...children) => {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.append(...children);
    return element;
  };
  const numbers = (text) => text.split(" ").map(Number);
  // The curves of a run: copies of those that are drawn, and their values by time
  const strip = (panel, curve) => {
    const copy = panel.cloneNode(true), group = copy.querySelector("g.axes");
    [...group.querySelectorAll("path")].forEach((path, place) => { if (place !== curve) path.remove(); });
    copy.querySelectorAll(".cursor, .at, .v1, .event, .flown").forEach((other) => other.remove());
    copy.setAttribute("viewBox", panel.dataset.views?.split("|")[0] ?? panel.getAttribute("viewBox"));
    for (const [key, value] of [["y", "0"], ["height", "100%"]]) copy.setAttribute(key, value);
    const clock = group.appendChild(made("line", { class: "clock" }));
    const outer = made("svg", { class: "plot", "aria-hidden": "true" });
    outer.append(copy);
    const [left, top, width, height] = numbers(group.dataset.box);
    const [t0, t1] = numbers(group.dataset.x), [y0, y1] = numbers(group.dataset.y);
    const points = pointsOf(group.querySelector("path")).map(([x, y]) => [t0 + (x - left) / width * (t1 - t0), y1 - (y - top) / height * (y1 - y0)]);
    return {
      outer,
      end: points[points.length - 1][0],
      at: (t) => {
        const x = left + (t - t0) / (t1 - t0) * width;
        for (const [key, value] of [["x1", x], ["x2", x], ["y1", top], ["y2", top + height]]) clock.setAttribute(key, value);
        let low = 0, high = points.length - 1;
        while (high - low > 1) { const middle = (low + high) >> 1; if (points[middle][0] <= t) low = middle; else high = middle; }
        const [[ta, a], [tb, b]] = [points[low], points[high]];
        return t >= tb || tb === ta ? b : t <= ta ? a : a + (t - ta) / (tb - ta) * (b - a);
      },
    };
  };
  const ready = figures.map(() => null);
  const runOf = (place) => (ready[place] ??= (() => {
    const figure = figures[place], { picture, curve, turn, half, push, times } = figure.dataset;
    const panels = histories[Number(picture)].querySelectorAll("svg.readings > svg");
    const rotation = strip(panels[0], Number(curve)), ground = strip(panels[panels.length - 1], 0);
    const strips = node("div", { class: "strips scripted" }, "θ/α", rotation.outer, "ground acceleration [g]", ground.outer);
    figure.querySelector(".stage").append(strips);
    const moves = figure.querySelector(".moves"), arrow = figure.querySelector(".push"), foot = arrow.getAttribute("d").match(/^M0 [\d.]+/)[0];
    const [from, to, peak] = numbers(times);
    return {
      from, to, now: peak,
      show(t) {
        this.now = Math.max(from, Math.min(to, t));
        const theta = rotation.at(this.now), g = ground.at(this.now), long = g * Number(push), head = 4 * Math.sign(long);
        moves.setAttribute("transform", `rotate(${theta * Number(turn)} ${Math.sign(theta) * Number(half)} 0)`);
        arrow.setAttribute("d", `${foot}h${long}` + (Math.abs(long) > 4 ? `m${-head} -3l${head} 3l${-head} 3` : ""));
        const ended = this.now > rotation.end + 0.1 ? "the curve ended at " : "";
        return `t = ${this.now.toFixed(2)} s, ${ended}θ/α = ${theta.toFixed(3)}, ground ${g.toFixed(3)} g`;
      },
    };
  })());
  let place = 0, speed = 1, before = null;
  const slider = node("input", { type: "range", step: "0.01", "aria-label": "Time [s]" });
  const says = node("output", { "aria-live": "off" });
  const show = (t) => {
    const words = runOf(place).show(t);
    slider.value = runOf(place).now;
    slider.setAttribute("aria-valuetext", words);
    says.textContent = words;
  };
  const play = node("button", { type: "button" }, "Play");
  const pause = () => { before = null; play.textContent = "Play"; };
  const frame = (time) => {
    if (before === null) return;
    const run = runOf(place);
    show(run.now + speed * (time - before) / 1000);
    before = time;
    if (run.now >= run.to) pause(); else requestAnimationFrame(frame);
  };
  play.addEventListener("click", () => {
    if (before !== null) { pause(); return; }
    const run = runOf(place);
    if (run.now >= run.to) show(run.from);
    play.textContent = "Pause";
    before = performance.now();
    requestAnimationFrame(frame);
  });
  const step = (words, by) => {
    const button = node("button", { type: "button", "aria-label": words }, by < 0 ? "◂ Step" : "Step ▸");
    button.addEventListener("click", () => { pause(); show(runOf(place).now + by); });
    return button;
  };
  const speeds = node("select", {}, ...[0.1, 0.25, 0.5, 1, 2, 5].map((value) => new Option(`× ${value}`, value, value === 1, value === 1)));
  speeds.addEventListener("change", () => { speed = Number(speeds.value); });
  slider.addEventListener("input", () => { pause(); show(Number(slider.value)); });
  const choose = (chosen) => {
    pause();
    place = chosen;
    figures.forEach((figure, i) => figure.classList.toggle("chosen", i === place));
    const run = runOf(place);
    for (const [key, value] of [["min", run.from], ["max", run.to]]) slider.setAttribute(key, value);
    show(run.now);
  };
  const cases = node("select", {}, ...figures.map((figure) => new Option(figure.querySelector("strong").textContent)));
  cases.addEventListener("change", () => choose(cases.selectedIndex));
  const calm = node("span", { class: "muted" }, "Reduced motion is asked for: step, or move the slider.");
  const settle = () => { pause(); play.hidden = still.matches; calm.hidden = !still.matches; };
  still.addEventListener("change", settle);
  const bar = node("div", { class: "buttons scripted", role: "group", "aria-label": "Play the worst run of a case" });
  if (figures.length > 1) bar.append(node("label", {}, "Case ", cases));
  bar.append(play, calm, step("A step of 0.02 s back", -0.02), step("A step of 0.02 s on", 0.02), node("label", {}, "Speed ", speeds), says, slider);
  player.before(bar);
  settle();
  choose(0);
}

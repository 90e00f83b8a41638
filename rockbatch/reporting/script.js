"use strict";
document.documentElement.classList.add("js");

// Tables: sort by any column, search
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const heads = [...table.tHead.rows[table.tHead.rows.length - 1].cells];

  // Numbers by value, ranges by their end, words by alphabet, nothing last; rows that tie stay in their order
  const number = (text) =>
    Number(text.replace("∞", "Infinity").replace(/^[≥≤]\s*/, "").split(" of ")[0].split("\u00a0–\u00a0").pop());
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
  copy.className = "copy scripted";
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
  table.parentElement.before(copy);

  if (rows.length < 8) continue;
  const box = document.createElement("label");
  const input = document.createElement("input");
  const count = document.createElement("span");
  box.className = "filter";
  input.type = "search";
  input.placeholder = "record, case, status …";
  count.className = "muted";
  count.setAttribute("aria-live", "polite");
  box.append("Search", input, count);
  table.parentElement.before(box);
  const filter = () => {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const row of rows) {
      const text = row.textContent.toLowerCase();
      row.hidden = !words.every((word) => text.includes(word));
      shown += row.hidden ? 0 : 1;
    }
    count.textContent = `${shown} of ${rows.length} rows`;
  };
  input.addEventListener("input", filter);
  filter();
}

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
    if (!step) return;
    event.preventDefault();
    const marks = marksOf(grid);
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
  const place = (group, x, y) => { // from the picture to the window
    const to = new DOMPoint(x, y).matrixTransform(group.getScreenCTM());
    return [to.x, to.y];
  };
  let cursor = null; // px in the picture
  const readTime = (px, clientY) => {
    const timed = axes().filter((one) => one.kind === "time");
    const { left, width } = timed[0];
    cursor = Math.max(left, Math.min(left + width, px));
    hush();
    const words = [`t = ${shown(timed[0].x(cursor), timed[0].xRange)} s`];
    for (const one of timed) {
      one.group.append(made("line", { class: "cursor", x1: cursor, x2: cursor, y1: one.top, y2: one.top + one.height }));
      for (const { name, points } of one.curves) {
        const after = points.findIndex(([x]) => x >= cursor);
        if (after < 0) continue;
        const [b, a] = [points[after], points[Math.max(0, after - 1)]];
        const y = b[0] === a[0] ? b[1] : a[1] + (cursor - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
        one.group.append(made("circle", { class: "at", cx: cursor, cy: y, r: 2 }));
        words.push(`${name} = ${shown(one.y(y), one.yRange)}`);
      }
    }
    const [x, y] = place(svg, cursor, timed[0].top);
    say(words.join("\n"), x, clientY ?? y);
  };
  const readPlane = (one, px, py, clientX, clientY) => {
    hush();
    const points = one.curves.flatMap((curve) => curve.points);
    const [x, y] = points.reduce((best, p) => Math.hypot(p[0] - px, p[1] - py) < Math.hypot(best[0] - px, best[1] - py) ? p : best);
    one.group.append(made("circle", { class: "at", cx: x, cy: y, r: 2 }));
    const [across, down] = one.names;
    say(`${across} = ${shown(one.x(x), one.xRange)}\n${down} = ${shown(one.y(y), one.yRange)}`, clientX, clientY);
  };
  const read = (event) => {
    for (const one of axes()) {
      const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(one.group.getScreenCTM().inverse());
      if (x < one.left - 2 || x > one.left + one.width + 2 || y < one.top || y > one.top + one.height) continue;
      if (one.kind === "time") readTime(x, event.clientY); else readPlane(one, x, y, event.clientX, event.clientY);
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
    readTime((cursor ?? axes()[0].left) + step * (event.shiftKey ? 10 : 1));
  });
}

// Paper: a table that is too wide would shrink every page, so that it goes on in tables below, each with the first column
const ROOM = 700; // px of a table on the screen, whose words are smaller on paper
const slices = (table) => {
  const heads = [...table.tHead.rows[table.tHead.rows.length - 1].cells];
  const found = [];
  let width = Infinity;
  heads.slice(1).forEach((head, i) => {
    const own = Math.min(head.offsetWidth, 300);
    if (width + own > ROOM) {
      found.push([]);
      width = Math.min(heads[0].offsetWidth, 300);
    }
    found[found.length - 1].push(i + 1);
    width += own;
  });
  return found;
};
const cut = (table, kept) => {
  const copy = table.cloneNode(true);
  const over = copy.tHead.rows.length > 1 ? [...copy.tHead.rows[0].cells] : [];
  let place = 0;
  for (const cell of over) {
    const own = Array.from({ length: cell.colSpan }, (_, i) => place + i).filter((column) => kept.includes(column));
    place += cell.colSpan;
    if (own.length) cell.colSpan = own.length; else cell.remove();
  }
  const rows = [copy.tHead.rows[copy.tHead.rows.length - 1], ...copy.tBodies[0].rows];
  for (const row of rows) [...row.cells].forEach((cell, i) => kept.includes(i) || cell.remove());
  return copy;
};
addEventListener("beforeprint", () => {
  for (const table of document.querySelectorAll(".wide > table")) {
    const parts = table.offsetWidth > ROOM && !table.parentElement.classList.contains("prose") ? slices(table) : [];
    if (parts.length < 2) continue;
    const paper = document.createElement("div");
    paper.className = "printed sliced";
    paper.append(...parts.map((part) => cut(table, [0, ...part])));
    table.parentElement.classList.add("whole-width");
    table.parentElement.after(paper);
  }
});
addEventListener("afterprint", () => {
  document.querySelectorAll(".sliced").forEach((paper) => paper.remove());
  document.querySelectorAll(".whole-width").forEach((wide) => wide.classList.remove("whole-width"));
});

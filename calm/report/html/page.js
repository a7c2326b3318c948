"use strict";
// Sorts the tables that can be sorted, and shows of their rows those that are asked for.
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const heads = [...table.tHead.rows[0].cells];
  const gravity = ["pass", "not-judged", "accepted", "estimated", "warn", "unknown", "fail"];
  const text = (row, column) => row.cells[column].firstChild?.textContent.trim() ?? "";

  const compare = (column) => (one, other) => {
    const [a, b] = [text(one, column), text(other, column)];
    if (gravity.includes(a) && gravity.includes(b)) return gravity.indexOf(a) - gravity.indexOf(b);
    const [x, y] = [parseFloat(a), parseFloat(b)];
    if (heads[column].classList.contains("number")) {
      return (Number.isNaN(x) ? -Infinity : x) - (Number.isNaN(y) ? -Infinity : y) || 0;
    }
    return a.localeCompare(b, "en", { numeric: true });
  };

  const sort = (column) => {
    const up = heads[column].getAttribute("aria-sort") !== "ascending";
    const order = compare(column);
    const rows = [...body.rows].sort((one, other) => (up ? order(one, other) : order(other, one)));
    heads.forEach((head) => head.removeAttribute("aria-sort"));
    heads[column].setAttribute("aria-sort", up ? "ascending" : "descending");
    body.append(...rows);
  };

  heads.forEach((head, column) => {
    head.tabIndex = 0;
    head.addEventListener("click", () => sort(column));
    head.addEventListener("keydown", (event) => {
      if (event.key === "Enter") sort(column);
    });
  });

  const controls = document.createElement("div");
  controls.className = "controls";
  const states = document.createElement("select");
  states.setAttribute("aria-label", "states shown");
  for (const name of ["all states", ...[...gravity].reverse()]) states.add(new Option(name));
  const words = document.createElement("input");
  words.type = "search";
  words.placeholder = "words";
  words.setAttribute("aria-label", "words shown");
  const count = document.createElement("span");
  const choose = () => {
    const wanted = words.value.toLowerCase();
    let shown = 0;
    for (const row of body.rows) {
      const state = row.querySelector(".state")?.textContent;
      const fits = states.selectedIndex === 0 || state === states.value;
      row.hidden = !(fits && row.textContent.toLowerCase().includes(wanted));
      shown += row.hidden ? 0 : 1;
    }
    count.textContent = `${shown} of ${body.rows.length} rows`;
  };
  states.addEventListener("change", choose);
  words.addEventListener("input", choose);
  controls.append(states, words, count);
  table.parentElement.before(controls);
  choose();
}

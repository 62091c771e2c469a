// Sorts a table by the column whose heading is pressed: numbers as numbers, ranges by their first.
"use strict";

const value = (cell) => {
  const text = cell.textContent.trim(), number = Number.parseFloat(text);
  return Number.isNaN(number) ? text : number;
};

function order(a, b) {
  if (typeof a === typeof b) return typeof a === "number" ? a - b : a.localeCompare(b);
  return typeof a === "number" ? -1 : 1;
}

function sort(table, column, heading) {
  const falling = heading.getAttribute("aria-sort") === "ascending", body = table.tBodies[0];
  for (const other of table.querySelectorAll("thead th")) other.removeAttribute("aria-sort");
  heading.setAttribute("aria-sort", falling ? "descending" : "ascending");
  const rows = [...body.rows].map((row) => [value(row.cells[column]), row]);
  rows.sort(([a], [b]) => (falling ? order(b, a) : order(a, b)));
  body.append(...rows.map(([, row]) => row));
}

for (const table of document.querySelectorAll("table")) {
  table.querySelectorAll("thead th").forEach((heading, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = heading.textContent;
    button.addEventListener("click", () => sort(table, column, heading));
    heading.replaceChildren(button);
  });
}

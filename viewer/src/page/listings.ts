// Tables, such as statistics.

import type { Listing } from "../data/run.ts";
import { h } from "./dom.ts";

/** One table under its title; wide ones move sideways within their card. */
export function listing({ title, headings, rows, note }: Listing): HTMLElement {
  const number = headings.map((_, i) => i > 0 && rows.every((row) => row[i] === "" || Number.isFinite(Number(row[i]))));
  const cell = (text: string, i: number) => (i === 0 ? h("th", { scope: "row" }, text) : h("td", number[i] ? { class: "number" } : {}, text.replace("-", "−")));
  const head = h("tr", {}, ...headings.map((text, i) => h("th", number[i] ? { scope: "col", class: "number" } : { scope: "col" }, text)));
  const table = h("table", {}, h("thead", {}, head), h("tbody", {}, ...rows.map((row) => h("tr", {}, ...row.map(cell)))));
  const wide = h("div", { class: "wide", tabindex: "0", role: "group", "aria-label": `Table: ${title}` }, table);
  return h("section", { class: "card", "aria-label": title }, h("div", { class: "row" }, h("h2", {}, title)), wide, h("p", { class: "muted" }, note));
}

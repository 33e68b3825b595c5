// What is told in words: how the run ended, warnings, events, settings, the balance of energy, the scene.

import type { Entry, Run } from "../data/run.ts";
import { timeText, withUnit } from "../data/text.ts";
import { $, h } from "./dom.ts";

function list(entries: Entry[]): HTMLElement {
  return h("dl", {}, ...entries.flatMap(({ name, value }) => [h("dt", {}, name), h("dd", {}, value)]));
}

function section(title: string, body: HTMLElement, open = true): HTMLElement {
  const details = h("details", { class: "card" }, h("summary", {}, h("h2", {}, title)), body);
  details.open = open;
  return details;
}

function bullets(texts: string[]): HTMLElement {
  return h("ul", {}, ...texts.map((text) => h("li", {}, text)));
}

/** The line of events: what happened when, each a button to go there. */
function events(run: Run, span: number, seek: (t: number) => void): HTMLElement {
  const row = ({ t, text }: Run["events"][number]) => {
    const button = h("button", { type: "button", class: "link" }, `${timeText(t, span)} ${run.axis.unit}`);
    button.addEventListener("click", () => seek(t));
    return h("li", {}, button, ` ${text}`);
  };
  return h("ol", { class: "events" }, ...run.events.map(row));
}

function parts(run: Run): HTMLElement {
  const { lines, bodies } = run.field;
  const rows = [...lines.map((l) => [l.name, l.kind, l.diameter > 0 ? withUnit(l.diameter, "m") : "", l.place]), ...bodies.map((b) => [b.name, b.kind, "", b.place])];
  const head = h("tr", {}, ...["part", "kind", "diameter", "in the scene"].map((t) => h("th", { scope: "col" }, t)));
  const body = rows.map((row) => h("tr", {}, ...row.map((text, i) => (i === 0 ? h("th", { scope: "row" }, text) : h("td", {}, text)))));
  return h("table", {}, h("thead", {}, head), h("tbody", {}, ...body));
}

export function facts(run: Run, span: number, seek: (t: number) => void): void {
  document.title = run.title || "Ropewalk";
  $("title").textContent = run.title;
  $("subtitle").textContent = run.subtitle;
  $("status").textContent = run.status;
  $("status").dataset.status = run.status;
  $("status").hidden = !run.status;
  if (run.warnings.length > 0) $("warnings").append(h("h2", {}, run.warnings.length > 1 ? `${run.warnings.length} warnings` : "Warning"), bullets(run.warnings));
  $("warnings").hidden = run.warnings.length === 0;
  const { lines, bodies } = run.field;
  const all: [string, boolean, () => HTMLElement, boolean?][] = [
    ["Summary", run.summary.length > 0, () => list(run.summary)],
    ["Events", run.events.length > 0, () => events(run, span, seek)],
    ...run.sections.map(({ title, entries }): [string, boolean, () => HTMLElement] => [title, entries.length > 0, () => list(entries)]),
    ["Balance of energy", run.energy.length > 0, () => list(run.energy)],
    ["Settings", run.settings.length > 0, () => list(run.settings)],
    ["Notes", run.notes.length > 0, () => bullets(run.notes)],
    ["Parts", lines.length + bodies.length > 0, () => parts(run)],
    ["Thinned for this page", run.thinned.length > 0, () => bullets([...run.thinned, "The tables of the run have all of it."])],
    ["Scene", run.scene !== "", () => h("pre", { tabindex: "0", "aria-label": "Text of the scene" }, run.scene), false],
  ];
  for (const [title, is, body, open] of all) if (is) $("facts").append(section(title, body(), open ?? true));
  $("thinned").hidden = run.thinned.length === 0;
}

// The page: reads its data, and ties the clock to the picture, the plots and the envelopes.

import { decode } from "./data/decode.ts";
import type { Run } from "./data/run.ts";
import { derive } from "./data/derive.ts";
import { short, timeText } from "./data/text.ts";
import { $, choices, h } from "./page/dom.ts";
import { facts } from "./page/facts.ts";
import { listing } from "./page/listings.ts";
import { Player } from "./page/player.ts";
import { themed } from "./page/theme.ts";
import { View } from "./page/view.ts";
import { Envelopes, type Drawn } from "./plots/envelopes.ts";
import { Histories } from "./plots/histories.ts";
import { Spectra } from "./plots/spectra.ts";
import { StepPlot } from "./plots/steps.ts";
import { TimeWindow } from "./plots/window.ts";

/** How often numbers change while the run plays [s]. */
const READ = 0.12;
/** How often cursors move on a machine that can't move them with every frame [s]. */
const REST = 0.08;

function start(run: Run): void {
  const { field, history } = run;
  derive(field);
  const ends = [field.times, history[0]?.values ?? new Float64Array()].filter((t) => t.length > 0);
  const first = Math.min(...ends.map((t) => t[0]!));
  const last = Math.max(...ends.map((t) => t.at(-1)!));
  const part = new TimeWindow(Number.isFinite(first) ? first : 0, Number.isFinite(last) ? last : 0);
  const moves = field.times.length > 0 && field.lines.length + field.bodies.length > 0;
  const span = part.last - part.first;

  let view: View | null = null;
  let histories: Histories | null = null;
  let envelopes: Envelopes | null = null;
  let spectra: Spectra | null = null;
  let steps: StepPlot | null = null;
  let sinceRead = 0;
  let sinceRest = 0;
  const show = (t: number, seconds: number) => {
    sinceRead += seconds;
    const read = seconds === 0 || sinceRead > READ;
    if (read) sinceRead = 0;
    view?.to(t, seconds);
    sinceRest += seconds;
    if (seconds === 0 || !view?.quality.slow || sinceRest > REST) {
      sinceRest = 0;
      player?.paint();
      histories?.to(t, read);
      envelopes?.to(t);
      steps?.to(t);
    }
    if (seconds === 0) say(t);
  };
  const player: Player = new Player(run, part, moves ? field.times : (history[0]?.values ?? []), show);
  const seek = (t: number) => player.seek(t);
  /** For those who don't see the picture. */
  const say = (t: number) => {
    const parts = field.lines.flatMap((line, i) => {
      const actor = view?.stage.lines[i];
      if (!actor || actor.count === 0) return [];
      const [x, y, z] = [0, 1, 2].map((j) => short(actor.x[3 * (actor.count - 1) + j]! + field.origin[j]!, 3));
      return [`end of ${line.name} at ${x}, ${y}, ${z} m`];
    });
    $("told").textContent = `${run.axis.name} = ${timeText(t, span)} ${run.axis.unit}. ${parts.join("; ")}`;
  };

  facts(run, span, seek);
  $("listings").append(...run.listings.map(listing));
  $("listings").hidden = run.listings.length === 0;
  document.body.classList.toggle("still", !moves);
  if (moves) {
    view = new View(run);
    view.time = () => player.clock.t;
  }
  $("player").hidden = !(span > 0);
  if (run.panels.length > 0) {
    histories = new Histories(run, $("histories"), part, seek);
    choosePanels(histories);
  }
  $("plots").hidden = run.panels.length === 0;
  windowInputs(part, span);
  envelopes = chooseEnvelope(run, part, seek);
  $("envelopes").hidden = !envelopes;
  if (history.length > 1 && run.axis.unit === "s" && history[0]!.values.length > 8) {
    $("spectra").hidden = false;
    spectra = new Spectra(run, part);
  }
  if (run.steps && run.steps.t.length > 0) {
    $("solver").hidden = false;
    steps = new StepPlot(run, run.steps, part, seek);
  }

  themed($("theme"), () => {
    view?.recolour();
    histories?.recolour();
    envelopes?.recolour();
    spectra?.recolour();
    steps?.recolour();
    envelopes?.to(player.clock.t);
  });
  new ResizeObserver(() => {
    view?.resize();
    histories?.resize();
    envelopes?.resize();
    spectra?.resize();
    steps?.resize();
  }).observe(document.body);
  player.seek(part.first);
  Object.assign(window, { ropewalk: { run, player, view, histories, envelopes, spectra, steps, part } });
  document.body.dataset.renderer = view?.picture.kind ?? "none";
  document.body.dataset.ready = "yes";
}

/** A box to tick for each panel. */
function choosePanels(histories: Histories): void {
  const names = histories.names();
  const boxes = names.map((name, k) => {
    const box = h("input", { type: "checkbox" });
    box.checked = histories.has(k);
    box.onchange = () => histories.show(k, box.checked);
    return h("label", {}, box, ` ${name}`);
  });
  $("panels").append(...boxes);
  $("panels-count").textContent = `Records (${names.length})`;
  const filter = $<HTMLInputElement>("filter");
  filter.hidden = names.length < 9;
  filter.oninput = () => boxes.forEach((label, k) => (label.hidden = !names[k]!.toLowerCase().includes(filter.value.toLowerCase())));
}

/** The window as two numbers. */
function windowInputs(part: TimeWindow, span: number): void {
  const [from, to] = [$<HTMLInputElement>("from"), $<HTMLInputElement>("to")];
  const write = () => {
    from.value = timeText(part.from, span).replace("−", "-");
    to.value = timeText(part.to, span).replace("−", "-");
    $<HTMLButtonElement>("whole").disabled = part.whole;
  };
  const read = () => {
    part.set(Number(from.value), Number(to.value));
    write();
  };
  from.onchange = to.onchange = read;
  $("whole").onclick = () => part.set(-Infinity, Infinity);
  part.changed(write);
  write();
  $("window").hidden = !(span > 0);
}

function chooseEnvelope(run: Run, part: TimeWindow, seek: (t: number) => void): Envelopes | null {
  const { lines } = run.field;
  const several = lines.length > 1;
  const ranges = run.ranges.map((range): Drawn => {
    const { name, quantity: what, unit } = range;
    const line = lines.find((line) => line.quantities.some((q) => q.name === what) && line.name === name);
    const quantity = line?.quantities.find((q) => q.name === what && q.unit === unit);
    return { title: `range of ${name}: ${what.replaceAll("_", " ")} [${unit || "-"}]`, unit, range, ...(line && quantity && { line, quantity }) };
  });
  const seen = lines.flatMap((line) => line.quantities.map((quantity): Drawn => {
    const { name, unit } = quantity;
    return { title: `${several ? `${line.name}: ` : ""}${name} [${unit || "-"}]`, unit, line, quantity };
  }));
  const all = [...ranges, ...seen];
  if (all.length === 0) return null;
  const envelopes = new Envelopes(run, $("envelope"), $("envelope-told"), part, all[0]!, seek);
  choices($("envelope-of"), all.map((a) => a.title), 0);
  $("envelope-of").onchange = (e) => envelopes.choose(all[Number((e.target as HTMLSelectElement).value)]!);
  return envelopes;
}

decode($("data").textContent ?? "").then(start).catch((error: unknown) => {
  const message = error instanceof Error ? error.message : String(error);
  document.body.append(h("p", { role: "alert" }, `This page can't be shown: ${message}`));
  console.error(error);
});


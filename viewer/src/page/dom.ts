// Elements without templates: text never becomes markup.

type Child = Node | string | null | undefined | false;

export function h<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Record<string, string> = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children.filter((c): c is Node | string => c !== null && c !== undefined && c !== false));
  return element;
}

export function $<T extends HTMLElement = HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (!element) throw new Error(`no element ${id}`);
  return element as T;
}

/** Fills a choice; the value of an option is its number. */
export function choices(select: HTMLSelectElement, names: string[], chosen: number): void {
  select.replaceChildren(...names.map((name, i) => h("option", { value: String(i) }, name)));
  select.value = String(chosen);
}

// Light, dark, or as the system has it; paper is always light.

const system = matchMedia("(prefers-color-scheme: dark)");
let chosen: "light" | "dark" | null = null;
let paper = false;

export function dark(): boolean {
  return !paper && (chosen ?? (system.matches ? "dark" : "light")) === "dark";
}

/** Sets the colours and tells whoever draws with them, now and whenever they change. */
export function themed(button: HTMLButtonElement, changed: () => void): void {
  const apply = () => {
    document.documentElement.dataset.theme = dark() ? "dark" : "light";
    button.textContent = dark() ? "Light" : "Dark";
    button.setAttribute("aria-label", dark() ? "Light colours" : "Dark colours");
    changed();
  };
  system.addEventListener("change", apply);
  button.addEventListener("click", () => {
    chosen = dark() ? "light" : "dark";
    apply();
  });
  const print = (on: boolean) => () => {
    paper = on;
    apply();
  };
  addEventListener("beforeprint", print(true));
  addEventListener("afterprint", print(false));
  apply();
}

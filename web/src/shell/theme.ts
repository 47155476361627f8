import { effect } from "@preact/signals";
import { theme } from "../state/preferences";

/** Keeps <html data-theme> as preferred; "system" follows the system while the page is open. */
export function applyTheme(): void {
  const light = matchMedia("(prefers-color-scheme: light)");
  const apply = () => {
    const chosen = theme.value === "system" ? (light.matches ? "light" : "dark") : theme.value;
    document.documentElement.dataset.theme = chosen;
  };
  effect(apply);
  light.addEventListener("change", apply);
}

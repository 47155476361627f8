import type { Signal } from "@preact/signals";
import { panels, type Panel } from "../panels";
import { bottomPanel, sidePanel } from "../state/preferences";
import { scene } from "../state/scene";
import { IconButton } from "../ui/controls";
import { Icon } from "../ui/icons";

/** Where the panels are shown, and the rail of buttons that opens them. */

const openIn = (panel: Panel): Signal<string | null> => (panel.place === "side" ? sidePanel : bottomPanel);

/** Opens a panel, or closes it when it is open. */
export function togglePanel(id: string): void {
  const panel = panels.find((one) => one.id === id);
  if (!panel) return;
  const open = openIn(panel);
  open.value = open.value === id ? null : id;
}

export function Rail() {
  return (
    <nav class="rail" aria-label="Panels">
      {panels.map((panel) => (
        <button
          key={panel.id}
          type="button"
          aria-pressed={openIn(panel).value === panel.id}
          title={panel.title}
          aria-label={panel.title}
          disabled={!scene.value}
          onClick={() => togglePanel(panel.id)}
        >
          <Icon name={panel.icon} size={18} />
        </button>
      ))}
    </nav>
  );
}

function Dock({ place, open }: { place: Panel["place"]; open: Signal<string | null> }) {
  const panel = panels.find((one) => one.place === place && one.id === open.value);
  if (!panel || !scene.value) return null;
  const Content = panel.component;
  return (
    <aside class={`dock ${place}`} aria-label={panel.title}>
      <header>
        <h2>{panel.title}</h2>
        <IconButton icon="close" label={`Close ${panel.title}`} onClick={() => (open.value = null)} />
      </header>
      <div class="dock-body">
        <Content key={panel.id} />
      </div>
    </aside>
  );
}

export const SideDock = () => <Dock place="side" open={sidePanel} />;
export const BottomDock = () => <Dock place="bottom" open={bottomPanel} />;

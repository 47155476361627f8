import { hello } from "../state/session";
import { Dialog } from "../ui/dialog";
import { helpShown } from "./page-state";
import { pointerHelp, shortcuts, type Shortcut } from "./shortcuts";

function Keys({ keys }: { keys: readonly string[] }) {
  return <span class="keys">{keys.map((key) => (key === "..." ? <span>to</span> : <kbd>{key}</kbd>))}</span>;
}

function Group({ title }: { title: Shortcut["group"] }) {
  return (
    <section>
      <h3>{title}</h3>
      <dl>
        {shortcuts
          .filter((one) => one.group === title)
          .map((one) => (
            <div key={one.what}>
              <dt>
                <Keys keys={one.keys} />
              </dt>
              <dd>{one.what}</dd>
            </div>
          ))}
      </dl>
    </section>
  );
}

/** All keys and gestures. */
export function Help() {
  if (!helpShown.value) return null;
  return (
    <Dialog title="Keys and gestures" wide onClose={() => (helpShown.value = false)}>
      <div class="help">
        <section>
          <h3>Pointer</h3>
          <dl>
            {pointerHelp.map((one) => (
              <div key={one.what}>
                <dt>{one.keys}</dt>
                <dd>{one.what}</dd>
              </div>
            ))}
          </dl>
        </section>
        <Group title="Camera" />
        <Group title="Tools" />
        <Group title="Page" />
      </div>
      <p class="version">voxlume {hello.value?.version}</p>
    </Dialog>
  );
}

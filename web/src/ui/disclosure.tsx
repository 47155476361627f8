import type { ComponentChildren } from "preact";
import { useId, useState } from "preact/hooks";
import { Icon } from "./icons";

/** What few need, folded away within a section. */
export function Disclosure(props: { label: string; children: ComponentChildren; open?: boolean }) {
  const [open, setOpen] = useState(props.open ?? false);
  const id = useId();
  return (
    <div class="disclosure">
      <button type="button" aria-expanded={open} aria-controls={id} onClick={() => setOpen(!open)}>
        <Icon name="chevron" size={10} />
        <span>{props.label}</span>
      </button>
      {open && (
        <div id={id} class="disclosure-body">
          {props.children}
        </div>
      )}
    </div>
  );
}

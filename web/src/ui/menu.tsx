import { Fragment, type ComponentChildren } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { Icon, type IconName } from "./icons";

export interface MenuItem {
  /** Begins a group of items under this title. */
  group?: string;
  label: string;
  hint?: string;
  icon?: IconName;
  /** Of a choice: whether it is the one. */
  checked?: boolean;
  disabled?: boolean;
  run(): void;
}

/** A button that opens a list of things to do. Arrow keys walk it, Escape closes it. */
export function Menu(props: {
  label: string;
  icon: IconName;
  items: readonly MenuItem[];
  children?: ComponentChildren;
  disabled?: boolean;
}) {
  const [open, setOpen] = useState(false);
  const root = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (!open) return;
    root.current?.querySelector<HTMLElement>("[role^=menuitem]")?.focus();
    const outside = (event: Event) => !root.current?.contains(event.target as Node) && setOpen(false);
    document.addEventListener("pointerdown", outside, true);
    document.addEventListener("focusin", outside);
    return () => {
      document.removeEventListener("pointerdown", outside, true);
      document.removeEventListener("focusin", outside);
    };
  }, [open]);
  const keyDown = (event: KeyboardEvent) => {
    if (!open) return;
    const items = [...root.current!.querySelectorAll<HTMLElement>("[role^=menuitem]")];
    const at = items.indexOf(document.activeElement as HTMLElement);
    if (event.key === "Escape") {
      setOpen(false);
      root.current?.querySelector("button")?.focus();
    } else if (event.key === "ArrowDown") items[(at + 1) % items.length]?.focus();
    else if (event.key === "ArrowUp") items[(at - 1 + items.length) % items.length]?.focus();
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <div ref={root} class="menu" onKeyDown={keyDown}>
      <button
        type="button"
        class="icon-button"
        aria-haspopup="menu"
        aria-expanded={open}
        aria-label={props.label}
        title={props.label}
        disabled={props.disabled}
        onClick={() => setOpen(!open)}
      >
        <Icon name={props.icon} />
        {props.children}
      </button>
      {open && (
        <div class="menu-list" role="menu" aria-label={props.label}>
          {props.items.map((item) => (
            <Fragment key={item.label}>
              {item.group && <div class="menu-group">{item.group}</div>}
              <button
                type="button"
                role={item.checked === undefined ? "menuitem" : "menuitemradio"}
                aria-checked={item.checked}
                disabled={item.disabled}
                onClick={() => {
                  setOpen(false);
                  item.run();
                }}
              >
                {item.checked !== undefined ? (
                  item.checked ? (
                    <Icon name="check" />
                  ) : (
                    <span class="no-icon" />
                  )
                ) : (
                  item.icon && <Icon name={item.icon} />
                )}
                <span class="menu-text">
                  {item.label}
                  {item.hint && <small>{item.hint}</small>}
                </span>
              </button>
            </Fragment>
          ))}
        </div>
      )}
    </div>
  );
}

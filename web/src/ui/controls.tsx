import type { ComponentChildren } from "preact";
import { useId, useLayoutEffect, useRef, useState } from "preact/hooks";
import { formatCoordinate, parseCoordinate } from "../geometry/length";
import type { Axis } from "../geometry/orientation";
import { reachFactor, typedScale, typedStep_mm } from "../state/lengths";
import { newGesture } from "../state/scene";
import { Icon, type IconName } from "./icons";

/** Small parts that all panels share. Changing parts hand on (value, gesture): the gesture is the same for all changes
 * of one drag and belongs into edit(). */

export type Change<T> = (value: T, gesture: string) => void;

/** A label left of its control; `hint` is the tooltip. */
export function Field(props: { label: string; hint?: string; for?: string; children: ComponentChildren }) {
  return (
    <div class="field" title={props.hint}>
      <label class="field-label" for={props.for}>{props.label}</label>
      <div class="field-control">{props.children}</div>
    </div>
  );
}

export interface NumberProps {
  value: number;
  onChange: Change<number>;
  min?: number;
  max?: number;
  /** Of the arrow keys; of lengths for an ordinary volume, whose voxels are about 1 mm. */
  step?: number;
  /** Digits after the point that are shown; of lengths at least as many as resolve a voxel. */
  digits?: number;
  /** "mm" for lengths. */
  unit?: string;
  /** It is a coordinate along this axis [LPS mm], written by the patient's side. */
  axis?: Axis;
  id?: string;
  label?: string;
  disabled?: boolean;
}

const clamp = (x: number, min = -Infinity, max = Infinity) => Math.min(max, Math.max(min, x));

/** From here on single units are not written. */
const kTooLong = 1e15;

const isLength = ({ unit, axis }: NumberProps) => unit === "mm" || axis !== undefined;

/** As the page writes it; empty where it is not finite. */
function textOf(props: NumberProps): string {
  const { value, axis, digits = 2 } = props;
  if (!Number.isFinite(value)) return "";
  if (axis !== undefined) return formatCoordinate(axis, value, typedScale.value);
  if (Math.abs(value) >= kTooLong) return String(Number(value.toPrecision(5)));
  return String(Number(value.toFixed(isLength(props) ? Math.max(digits, typedScale.value.digits) : digits)));
}

const isWhollySelected = (input: HTMLInputElement) =>
  input === document.activeElement && input.selectionStart === 0 && input.selectionEnd === input.value.length;

/** What an arrow key changes it by. */
const stepOf = (props: NumberProps) => (props.step ?? 1) * (isLength(props) ? typedStep_mm.value : 1);

/** A number to type; Enter or leaving takes it, Escape does not, arrow keys step (Shift: ten steps). */
export function NumberInput(props: NumberProps) {
  const [draft, setDraft] = useState<string | null>(null);
  const gesture = useRef("");
  const text = textOf(props);
  const field = useRef<HTMLInputElement>(null);
  // A number that changes by itself stays selected as a whole: what is typed replaces it.
  const whole = field.current !== null && isWhollySelected(field.current);
  useLayoutEffect(() => {
    if (whole && field.current === document.activeElement) field.current!.select();
  }, [text]);
  const take = (typed: string) => {
    setDraft(null);
    const value = props.axis === undefined ? Number(typed.replace(",", ".")) : parseCoordinate(props.axis, typed);
    if (typed.trim() !== "" && Number.isFinite(value) && typed !== text)
      props.onChange(clamp(value, props.min, props.max), newGesture("number"));
  };
  const keyDown = (event: KeyboardEvent) => {
    const input = event.currentTarget as HTMLInputElement;
    if (event.key === "Enter") take(input.value);
    else if (event.key === "Escape" && draft !== null) {
      setDraft(null);
      event.stopPropagation();
    } else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
      event.preventDefault();
      if (!event.repeat) gesture.current = newGesture("number");
      const by = stepOf(props) * (event.shiftKey ? 10 : 1) * (event.key === "ArrowUp" ? 1 : -1);
      setDraft(null);
      props.onChange(clamp(props.value + by, props.min, props.max), gesture.current);
    }
  };
  return (
    <span class="number">
      <input
        ref={field}
        id={props.id}
        type="text"
        inputMode={props.axis === undefined ? "decimal" : "text"}
        autocomplete="off"
        aria-label={props.label ? (props.unit ? `${props.label} [${props.unit}]` : props.label) : undefined}
        disabled={props.disabled}
        value={draft ?? text}
        style={{ "--letters": text.length }}
        onFocus={(event) => event.currentTarget.select()}
        onInput={(event) => setDraft(event.currentTarget.value)}
        onBlur={(event) => draft !== null && take(event.currentTarget.value)}
        onKeyDown={keyDown}
      />
      {props.unit && <span class="unit" aria-hidden="true">{props.unit}</span>}
    </span>
  );
}

export interface SliderProps extends NumberProps {
  label: string;
  /** Its ends; of lengths for an ordinary volume. */
  min: number;
  max: number;
  hint?: string;
  /** Equal ratios are equal ways; min > 0. */
  logarithmic?: boolean;
  /** The number may be typed beyond the slider's ends, within these. */
  hardMin?: number;
  hardMax?: number;
  /** Where a double click on the label goes back to. */
  initial?: number;
}

const kSliderSteps = 1000;

/** A slider with its number and unit. */
export function Slider(props: SliderProps) {
  const id = useId();
  const gesture = useRef<string | null>(null);
  const { logarithmic } = props;
  // A coordinate's slider has the volume's own ends.
  const reach = props.unit === "mm" && props.axis === undefined ? reachFactor.value : 1;
  const [min, max] = [props.min * reach, props.max * reach];
  const share = logarithmic
    ? Math.log(clamp(props.value, min, max) / min) / Math.log(max / min)
    : (clamp(props.value, min, max) - min) / (max - min || 1);
  const at = (s: number) => {
    const value = logarithmic ? min * (max / min) ** s : min + s * (max - min);
    if (logarithmic) return Number(value.toPrecision(3));
    return props.step ? clamp(Math.round(value / stepOf(props)) * stepOf(props), min, max) : value;
  };
  const slide = (event: Event) => {
    gesture.current ??= newGesture("slider");
    props.onChange(at(Number((event.currentTarget as HTMLInputElement).value) / kSliderSteps), gesture.current);
  };
  const reset = () => props.initial !== undefined && props.onChange(props.initial, newGesture("slider"));
  return (
    <div class={props.disabled ? "slider disabled" : "slider"} title={props.hint}>
      <label for={id} onDblClick={reset}>{props.label}</label>
      <NumberInput {...props} id={undefined} min={props.hardMin ?? min} max={props.hardMax ?? max} />
      <input
        id={id}
        type="range"
        min={0}
        max={kSliderSteps}
        value={Math.round(share * kSliderSteps)}
        disabled={props.disabled}
        style={{ "--share": share }}
        aria-valuetext={`${textOf(props)}${props.unit ? ` ${props.unit}` : ""}`}
        onInput={slide}
        onChange={() => (gesture.current = null)}
      />
    </div>
  );
}

export interface Option<T extends string> {
  value: T;
  label: string;
  hint?: string;
}

export function Select<T extends string>(props: {
  label: string;
  value: T;
  options: readonly Option<T>[];
  onChange(value: T): void;
  hint?: string;
  disabled?: boolean;
}) {
  const id = useId();
  return (
    <Field label={props.label} hint={props.hint} for={id}>
      <span class="select">
        <select
          id={id}
          value={props.value}
          disabled={props.disabled}
          onChange={(event) => props.onChange(event.currentTarget.value as T)}
        >
          {props.options.map((option) => (
            <option key={option.value} value={option.value} title={option.hint}>{option.label}</option>
          ))}
        </select>
        <Icon name="chevron" size={12} />
      </span>
    </Field>
  );
}

/** One of few, all in sight. */
export function Segmented<T extends string>(props: {
  label: string;
  value: T;
  options: readonly Option<T>[];
  onChange(value: T): void;
  hint?: string;
}) {
  const name = useId();
  return (
    <Field label={props.label} hint={props.hint}>
      <div class="segmented" role="radiogroup" aria-label={props.label}>
        {props.options.map((option) => (
          <label key={option.value} title={option.hint}>
            <input
              type="radio"
              name={name}
              checked={option.value === props.value}
              onChange={() => props.onChange(option.value)}
            />
            <span>{option.label}</span>
          </label>
        ))}
      </div>
    </Field>
  );
}

export function Toggle(props: {
  label: string;
  value: boolean;
  onChange(value: boolean): void;
  hint?: string;
  disabled?: boolean;
}) {
  const id = useId();
  return (
    <div class="toggle" title={props.hint}>
      <label for={id}>{props.label}</label>
      <input
        id={id}
        type="checkbox"
        role="switch"
        checked={props.value}
        disabled={props.disabled}
        onChange={(event) => props.onChange(event.currentTarget.checked)}
      />
    </div>
  );
}

/** A color as "#rrggbb" (sRGB); src/color.ts turns the scene's colors into it. */
export function ColorField(props: {
  label: string;
  value: string;
  onChange: Change<string>;
  hint?: string;
  /** Only the swatch; the label is its name for screen readers. */
  bare?: boolean;
}) {
  const id = useId();
  const gesture = useRef<string | null>(null);
  const input = (
    <input
      id={id}
      class="color"
      type="color"
      value={props.value}
      aria-label={props.bare ? props.label : undefined}
      onInput={(event) => {
        gesture.current ??= newGesture("color");
        props.onChange(event.currentTarget.value, gesture.current);
      }}
      onChange={() => (gesture.current = null)}
    />
  );
  if (props.bare) return input;
  return (
    <Field label={props.label} hint={props.hint} for={id}>
      <span class="color-text">{props.value}</span>
      {input}
    </Field>
  );
}

/** A button with an icon and no text; `label` is its name and tooltip. */
export function IconButton(props: {
  icon: IconName;
  label: string;
  onClick(event: MouseEvent): void;
  /** Of a button that switches something: whether it is on. */
  pressed?: boolean;
  disabled?: boolean;
  /** Shown in the tooltip. */
  keys?: string;
  class?: string;
}) {
  return (
    <button
      type="button"
      class={`icon-button ${props.class ?? ""}`}
      aria-label={props.label}
      aria-pressed={props.pressed}
      title={props.keys ? `${props.label} (${props.keys})` : props.label}
      disabled={props.disabled}
      onClick={props.onClick}
    >
      <Icon name={props.icon} />
    </button>
  );
}

/** A button with text. */
export function Button(props: {
  children: ComponentChildren;
  onClick(event: MouseEvent): void;
  icon?: IconName;
  primary?: boolean;
  disabled?: boolean;
  title?: string;
}) {
  return (
    <button
      type="button"
      class={props.primary ? "button primary" : "button"}
      disabled={props.disabled}
      title={props.title}
      onClick={props.onClick}
    >
      {props.icon && <Icon name={props.icon} />}
      {props.children}
    </button>
  );
}

/** A part of a panel that can be folded; `actions` stand right of its title. */
export function Section(props: {
  title: string;
  children: ComponentChildren;
  actions?: ComponentChildren;
  closed?: boolean;
}) {
  const [open, setOpen] = useState(!props.closed);
  const id = useId();
  return (
    <section class="section">
      <header>
        <button type="button" class="fold" aria-expanded={open} aria-controls={id} onClick={() => setOpen(!open)}>
          <Icon name="chevron" size={12} />
          <span>{props.title}</span>
        </button>
        {props.actions && <span class="actions">{props.actions}</span>}
      </header>
      {open && <div id={id} class="section-body">{props.children}</div>}
    </section>
  );
}

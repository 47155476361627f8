import { edit } from "../state/scene";
import { Slider, type SliderProps } from "../ui/controls";

/** A number of the scene: its name, range, unit and step. */
export interface NumberField extends Omit<SliderProps, "value" | "onChange" | "disabled" | "id"> {
  /** Whole numbers only. */
  whole?: boolean;
}

/** The sliders of the fields of one part of the scene; the table's keys are the fields' own names:
 * `<CameraNumber of={camera} name="zoom" />`. Whatever else is given counts instead of what the table says, and `at`
 * instead of the part's address. */
export function numberFields<Name extends string>(part: string, table: Record<Name, NumberField>) {
  interface Props extends Partial<Omit<SliderProps, "id">> {
    name: Name;
    of?: Partial<Record<Name, number>>;
    at?: string;
  }
  return function NumberOf({ name, of, at = part, ...given }: Props) {
    const { whole, ...field } = table[name];
    const set = (value: number, gesture: string) =>
      edit([[`${at}/${name}`, whole ? Math.round(value) : value]], gesture);
    return <Slider value={of?.[name] ?? 0} onChange={set} {...field} {...given} />;
  };
}

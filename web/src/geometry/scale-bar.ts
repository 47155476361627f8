/** The longest of 1, 2, 5 times a power of ten [mm] that is at most `longest_mm`, and how it is written. */
export function niceLength(longest_mm: number): { mm: number; label: string } {
  const power = 10 ** Math.floor(Math.log10(longest_mm));
  const digit = [5, 2, 1].find((d) => d * power <= longest_mm * (1 + 1e-9)) ?? 1;
  const mm = digit * power;
  return { mm, label: formatLength(mm) };
}

/** "2 cm", "5 mm", "20 µm": the largest unit in which it is 1 or more. */
export function formatLength(mm: number): string {
  const tidy = (x: number) => String(Number(x.toPrecision(6)));
  if (mm >= 1000) return `${tidy(mm / 1000)} m`;
  if (mm >= 10) return `${tidy(mm / 10)} cm`;
  if (mm >= 1) return `${tidy(mm)} mm`;
  return `${tidy(mm * 1000)} µm`;
}

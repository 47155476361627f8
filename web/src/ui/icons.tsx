/** Icons as inline SVG on a 16 x 16 grid, in the color of the text. */

const paths = {
  add: "M8 3v10M3 8h10",
  box: "M8 1.8l5.5 3.1v6.2L8 14.2l-5.5-3.1V4.9zM2.5 4.9L8 8l5.5-3.1M8 8v6.2",
  camera: "M2 4.5h3l1-1.7h4l1 1.7h3v8H2zM8 11a2.5 2.5 0 1 0 0-5 2.5 2.5 0 0 0 0 5z",
  check: "M3 8.5l3.2 3L13 4.5",
  chevron: "M6 4l4 4-4 4",
  close: "M4 4l8 8M12 4l-8 8",
  clip: "M4.5 1.5v10h10M1.5 4.5h10v10",
  copy: "M5.5 5.5h8v8h-8zM10.5 5.5v-3h-8v8h3",
  curve: "M2 13h12M2 13V3M3.5 11.5c3 0 3-7 5.5-7S11 8 13.5 8",
  delete: "M3 4.5h10M6.5 4.5V3h3v1.5M4.5 4.5l.6 8.5h5.8l.6-8.5M6.7 7v3.5M9.3 7v3.5",
  denoise: "M3 3h.01M6 5h.01M3 7h.01M5.5 9h.01M3 11h.01M6 13h.01M8.5 2v12M11 5h3M11 8h3M11 11h3",
  download: "M8 2.5v7.5M4.7 7L8 10.3 11.3 7M3 13.5h10",
  enlarge: "M2 13.500h12M3 11c5 0 6-1.500 10-1.500M8 8V2.500M5.700 4.700L8 2.400l2.300 2.300",
  eye: "M1.5 8S4 3.5 8 3.5 14.5 8 14.5 8 12 12.5 8 12.5 1.5 8 1.5 8zM8 10a2 2 0 1 0 0-4 2 2 0 0 0 0 4z",
  "eye-off":
    "M1.5 8S4 3.5 8 3.5 14.5 8 14.5 8 12 12.5 8 12.5 1.5 8 1.5 8zM2.5 2.5l11 11",
  fit: "M2.5 5.5v-3h3M10.5 2.5h3v3M13.5 10.5v3h-3M5.5 13.5h-3v-3M8 10a2 2 0 1 0 0-4 2 2 0 0 0 0 4z",
  film: "M2 3h12v10H2zM5 3v10M11 3v10M2 6.3h3M2 9.7h3M11 6.3h3M11 9.7h3",
  folder: "M2 12.5v-9h4.2l1.3 1.7H14v7.3z",
  fullscreen: "M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10",
  file: "M3.5 1.5h6l3 3v10h-9zM9.5 1.5v3h3",
  help: "M6 6.2a2 2 0 1 1 2.8 1.9c-.6.3-.8.7-.8 1.4M8 11.7h.01M8 14.5a6.5 6.5 0 1 0 0-13 6.5 6.5 0 0 0 0 13z",
  key: "M8 2.5L13.5 8 8 13.5 2.5 8z",
  labels: "M2 2.5h5.5L14 9l-5 5-6.5-6.5zM5 5.5h.01",
  layers: "M8 2l6 3-6 3-6-3zM2 8l6 3 6-3M2 11l6 3 6-3",
  light: "M8 11a3 3 0 1 0 0-6 3 3 0 0 0 0 6zM8 1.5v1.5M8 13v1.5M1.5 8H3M13 8h1.5M3.4 3.4l1.1 1.1M11.5 11.5l1.1 1.1M12.6 3.4l-1.1 1.1M4.5 11.5l-1.1 1.1",
  link: "M6.5 9.5l3-3M7 4.5l1.3-1.3a2.8 2.8 0 0 1 4 4L11 8.5M9 11.5l-1.3 1.3a2.8 2.8 0 0 1-4-4L5 7.5",
  measure: "M1.8 10.8l9-9 3.4 3.4-9 9zM4.5 8.2l1.4 1.4M7 5.7l1.4 1.4M9.5 3.2l1.4 1.4",
  menu: "M2.5 4h11M2.5 8h11M2.5 12h11",
  minus: "M3 8h10",
  moon: "M13 9.5A5.5 5.5 0 1 1 6.5 3 4.5 4.5 0 0 0 13 9.5z",
  orbit: "M8 10a2 2 0 1 0 0-4 2 2 0 0 0 0 4zM14.5 8c0 1.9-2.9 3.3-6.5 3.3S1.5 9.9 1.5 8 4.4 4.7 8 4.7 14.5 6.1 14.5 8z",
  parallel: "M3 3h10M3 8h10M3 13h10M3 3v10M13 3v10",
  pause: "M5 3v10M11 3v10",
  perspective: "M2 2.5l12 3v5l-12 3zM2 8h12M8 4v8",
  play: "M4.5 2.5l8.5 5.5-8.5 5.5z",
  redo: "M13 6.5H6a3.5 3.5 0 0 0 0 7h3M10 3.5l3 3-3 3",
  reset: "M3 8a5 5 0 1 0 1.7-3.8M3 2.5v3h3",
  save: "M2.5 2.5h9l2 2v9h-11zM5 2.5v4h5.5v-4M4.8 13.5V9.5h6.4v4",
  settings: "M2 4.5h6M11 4.5h3M2 11.5h3M8 11.5h6M9.5 6a1.5 1.5 0 1 0 0-3 1.5 1.5 0 0 0 0 3zM6.5 13a1.5 1.5 0 1 0 0-3 1.5 1.5 0 0 0 0 3z",
  slices: "M2.5 2.5h11v11h-11zM8 2.5v11M2.5 8h11",
  split: "M2 3h12v10H2zM8 1.5v13M4 6h.01M5.5 8h.01M4 10h.01",
  star: "M8 2l1.8 3.9 4.2.5-3.1 2.9.8 4.2L8 11.4 4.3 13.5l.8-4.2L2 6.4l4.2-.5z",
  sun: "M8 11a3 3 0 1 0 0-6 3 3 0 0 0 0 6zM8 1.5v1.5M8 13v1.5M1.5 8H3M13 8h1.5",
  undo: "M3 6.5h7a3.5 3.5 0 0 1 0 7H7M6 3.5l-3 3 3 3",
  upload: "M8 10.5V3M4.7 6.3L8 3l3.3 3.3M3 13.5h10",
  volume: "M8 1.8l5.5 3.1v6.2L8 14.2l-5.5-3.1V4.9zM2.5 4.9L8 8l5.5-3.1M8 8v6.2",
  warning: "M8 2.2l6.3 11.3H1.7zM8 6.5v3.5M8 12h.01",
} as const;

export type IconName = keyof typeof paths;

export function Icon({ name, size = 16 }: { name: IconName; size?: number }) {
  return (
    <svg class="icon" width={size} height={size} viewBox="0 0 16 16" aria-hidden="true">
      <path d={paths[name]} />
    </svg>
  );
}

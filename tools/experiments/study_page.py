"""A page of tables, plots and pictures in one HTML file, with the standard library alone."""
import base64
import html
import math

MAX_EMBEDDED_BYTES = 40 << 20  # of pictures; what comes after is linked

STYLE = """
:root{color-scheme:light dark;--bg:#fcfcfb;--fg:#1d2125;--dim:#6a7178;--rule:#d9dcdf;--card:#f3f4f4}
@media(prefers-color-scheme:dark){:root{--bg:#14171a;--fg:#e6e8ea;--dim:#98a0a8;--rule:#31373d;--card:#1c2125}}
body{background:var(--bg);color:var(--fg);font:15px/1.5 system-ui,sans-serif;max-width:1180px;margin:2rem auto;padding:0 1rem}
h1{font-size:1.6rem}h2{margin-top:2.4rem;border-bottom:1px solid var(--rule);font-size:1.25rem}h3{font-size:1rem;margin-bottom:.3rem}
p,li{max-width:85ch}table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:13px;margin:.6rem 0}
td,th{padding:.15rem .6rem;border-bottom:1px solid var(--rule);text-align:right}td:first-child,th:first-child{text-align:left}
.best{font-weight:700}.missed{color:#c8372d}.scroll{overflow-x:auto}.dim{color:var(--dim)}
.grid-of{display:grid;grid-template-columns:repeat(auto-fill,minmax(320px,1fr));gap:.6rem}
.pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(220px,1fr));gap:.4rem}
figure{margin:0}figure img{width:100%;display:block;background:#000}figcaption{font-size:12px;color:var(--dim)}
svg.plot{width:100%;height:auto;background:var(--card);border-radius:4px}
.plot text{font:10px system-ui,sans-serif;fill:var(--fg)}.plot .tick{font-size:9px;fill:var(--dim)}.plot .title{font-weight:600}
.plot .grid{stroke:var(--rule);stroke-width:.6;fill:none}.line{fill:none;stroke:var(--c);stroke-width:1.5}
.box{stroke:var(--c)}.box path{fill:none;stroke:var(--c);stroke-width:1.2}.box rect{fill:var(--c);fill-opacity:.3}.box .median{stroke-width:2.2}
.key span{white-space:nowrap;margin-right:1rem;font-size:13px}.key i{display:inline-block;width:18px;height:3px;background:var(--c);vertical-align:middle;margin-right:5px}
"""


def text(value):
    if value is None:
        return "–"
    if isinstance(value, float):
        return "–" if math.isnan(value) else f"{value:.3g}" if abs(value) < 1 else f"{value:.2f}"
    return str(value)


def table(header, rows, best=()):
    """`best`: {column: min or max}; that row's cell is bold."""
    choice = {}
    for column, pick in dict(best).items():
        values = [(r[column], i) for i, r in enumerate(rows) if isinstance(r[column], float)]
        if values:
            choice[column] = pick(values)[1]
    out = ["<div class=scroll><table><tr>" + "".join(f"<th>{html.escape(h)}</th>" for h in header) + "</tr>"]
    for i, row in enumerate(rows):
        cells = []
        for column, value in enumerate(row):
            kind = ' class="best"' if choice.get(column) == i else ""
            cells.append(f"<td{kind}>{html.escape(text(value))}</td>")
        out.append("<tr>" + "".join(cells) + "</tr>")
    return "".join(out) + "</table></div>"


class Page:
    """`style`: classes of colours, `.name{--c:#rrggbb}`, beside STYLE."""

    def __init__(self, folder, style=""):
        self.folder, self.parts, self.embedded, self.style = folder, [], 0, style

    def add(self, text):
        self.parts.append(text)

    def pictures(self, names):
        """`names`: (file without its ending, caption); those that are missing are left out."""
        out = []
        for name, caption in names:
            path = self.folder / "pictures" / f"{name}.png"
            if not path.exists():
                continue
            source = f"pictures/{name}.png"
            if self.embedded < MAX_EMBEDDED_BYTES:
                data = path.read_bytes()
                self.embedded += len(data)
                source = "data:image/png;base64," + base64.b64encode(data).decode()
            out.append(f'<figure><img src="{source}" alt="{html.escape(caption)}"><figcaption>{html.escape(caption)}</figcaption></figure>')
        if out:
            self.add('<div class="pictures">' + "".join(out) + "</div>")

    def key(self, entries):
        """`entries`: (class of the colour, name)."""
        self.add('<p class="key">' + "".join(
            f'<span class="{colour}"><i></i>{html.escape(name)}</span>' for colour, name in entries) + "</p>")

    def plots(self, made):
        self.add('<div class="grid-of">' + "".join(made) + "</div>")

    def write(self, title):
        text = (f'<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
                f"<title>{html.escape(title)}</title><style>{STYLE}{self.style}</style><h1>{html.escape(title)}</h1>" + "\n".join(self.parts) + "</html>\n")
        (self.folder / "index.html").write_text(text)

"""Reads what voxlume_denoise_study left and makes the tables and words of its page."""
import collections
import csv
import html
import math
import statistics

from study_page import text

GOAL_DB = 6.0
SUMMARY_HEADER = ["method", "PSNR, dB", "gain over noisy, dB", "FLIP", "SSIM", "variance / noisy's", "median denoise, ms"]
EXTRA = ("decoupled-one-class", "decoupled-no-decoupling")


def mean(values):
    values = list(values)
    return statistics.fmean(values) if values else math.nan


class Study:
    def __init__(self, folder):
        self.folder = folder
        self.rows = self.read("over-time-*.csv")
        self.variance_rows = self.read("variance-*.csv")
        self.convergence_rows = self.read("convergence-*.csv")
        self.index = collections.defaultdict(list)
        for r in self.rows:
            self.index[r["data"], r["animation"], r["spp"], r["method"]].append(r)

    def read(self, pattern):
        rows = []
        for path in sorted(self.folder.glob(pattern)):
            with path.open() as file:
                rows += csv.DictReader(file)
        return rows

    # Sequences and methods that there are.

    def sequences(self, main=False):
        found = dict.fromkeys((r["data"], r["animation"]) for r in self.rows)
        media = ("semi-transparent", "homogeneous")
        return [s for s in found if not (main and s[0] in media)]

    def spps(self):
        return sorted({int(r["spp"]) for r in self.rows if r["method"] != "reference"})

    def methods(self):
        return [m for m in dict.fromkeys(r["method"] for r in self.rows) if m != "reference"]

    def steady_methods(self):
        return list(dict.fromkeys(r["method"] for r in self.variance_rows))

    def compared(self, data, animation, spp, method):
        return [r for r in self.index[data, animation, str(spp), method] if r["compared"] == "1"]

    def mean_of(self, data, animation, spp, method, column):
        return mean(float(r[column]) for r in self.compared(data, animation, spp, method))

    def curve(self, data, animation, spp, method, column):
        return [(int(r["frame"]), float(r[column])) for r in self.compared(data, animation, spp, method)]

    def floor(self, data, animation, column):
        return mean(float(r[column]) for r in self.rows
                    if (r["data"], r["animation"], r["method"]) == (data, animation, "reference"))

    def shown_frame(self, data, animation):
        frames = [int(r["frame"]) for r in self.rows if (r["data"], r["animation"]) == (data, animation)]
        return 61 if animation == "transfer" and max(frames) > 61 else max(frames)

    # Temporal measures.

    def variance(self, data, animation, spp, method):
        return mean(float(r["variance_sum"]) for r in self.variance_rows
                    if (r["data"], r["animation"], r["spp"], r["method"]) == (data, animation, str(spp), method))

    def relative_variance(self, sequence, spp, method):
        noisy = self.variance(*sequence, spp, "noisy")
        return self.variance(*sequence, spp, method) / noisy if noisy > 0 else math.nan

    def relative_variances(self, spp, method):
        values = [self.relative_variance(s, spp, method) for s in self.sequences(main=True)]
        return [v for v in values if not math.isnan(v)]

    def convergence(self, spp, method):
        """Seconds of sequences that converged, their frames, and how many never did."""
        rows = [r for r in self.convergence_rows if r["spp"] == str(spp) and r["method"] == method]
        done = [r for r in rows if r["frames"]]
        return [float(r["seconds"]) for r in done], [int(r["frames"]) for r in done], len(rows) - len(done)

    def convergence_row(self, spp, method):
        seconds, frames, never = self.convergence(spp, method)
        return [float(statistics.median(frames)) if frames else None, statistics.median(seconds) if seconds else None, never]

    # Tables.

    def summary(self, spp):
        """Rows of SUMMARY_HEADER over the sequences of anatomy."""
        rows, sequences = [], self.sequences(main=True)
        for method in self.methods():
            if method in EXTRA:
                continue
            frames = {s: [r["frame"] for r in self.compared(*s, spp, method)] for s in sequences}
            values = {c: mean(self.mean_of(*s, spp, method, c) for s in sequences) for c in ("psnr_db", "flip", "ssim")}
            # Of the same frames: a slow method is compared on fewer.
            noisy = mean(mean(float(r["psnr_db"]) for r in self.compared(*s, spp, "noisy") if r["frame"] in frames[s])
                         for s in sequences)
            ms = [float(r["denoise_ms"]) for s in sequences for r in self.compared(*s, spp, method)]
            rows.append([method, values["psnr_db"], values["psnr_db"] - noisy, values["flip"], values["ssim"],
                         mean(self.relative_variances(spp, method)) if self.relative_variances(spp, method) else None,
                         statistics.median(ms) if method != "noisy" and ms else None])
        return rows

    def goals(self):
        low, high = self.spps()[0], self.spps()[-1]
        header = ["sequence", "noisy, dB", "reference's own, dB", "decoupled, dB", "gain, dB", "one frame without history, dB", "gain, dB", f"+{GOAL_DB:.0f} dB"]
        rows = []
        for data, animation in self.sequences():
            noisy, with_history, alone = (self.mean_of(data, animation, low, m, "psnr_db") for m in ("noisy", "decoupled", "decoupled-no-history"))
            missed = [w for w, v in (("with history", with_history), ("one frame", alone)) if v - noisy < GOAL_DB]
            rows.append([f"{data}, {animation}", noisy, self.floor(data, animation, "psnr_db"), with_history, with_history - noisy, alone,
                         alone - noisy, "missed: " + ", ".join(missed) if missed else "holds"])
        result = [(f"At {low} spp, {GOAL_DB:.0f} dB over the noisy picture", header, rows)]
        rows = []
        # xu2024 is the decoupled method with the paper's history, too late to be a rival where light changes: in a row of its own.
        others = [m for m in self.methods() if m not in ("noisy", "xu2024", "oidn") and not m.startswith("decoupled")]
        for s in self.sequences():
            row = [", ".join(s)]
            for value_of in (lambda m: self.mean_of(*s, high, m, "flip"), lambda m: self.relative_variance(s, high, m)):
                ranked = sorted((value_of(m), m) for m in others if not math.isnan(value_of(m)))
                own = value_of("decoupled")
                if not ranked or math.isnan(own):
                    row += [None, None, None]
                    continue
                row += [own, f"{text(ranked[0][0])} ({ranked[0][1]})", "holds" if own < ranked[0][0] else "missed"]
            rows.append(row)
        rows.append(self.mean_goal(high, others))
        if "xu2024" in self.methods():
            rows.append(self.against_xu2024(high))
        result.append((f"At {high} spp, ahead of every other method that is not neural", ["sequence", "FLIP", "best other", "", "variance / noisy's", "best other", ""], rows))
        return result

    def against_xu2024(self, spp):
        """The same mean against the method that the rows above leave out, with what it is worth."""
        psnr = [text(mean(self.mean_of(*s, spp, m, "psnr_db") for s in self.sequences(main=True))) for m in ("decoupled", "xu2024")]
        row = self.mean_goal(spp, ["xu2024"])
        row[0] += f", against xu2024, which the rows above leave out: {psnr[1]} dB, decoupled {psnr[0]} dB"
        return row

    def mean_goal(self, spp, others):
        """The row of the mean over the sequences of anatomy."""
        row, sequences = ["mean of the sequences of anatomy"], self.sequences(main=True)
        for value_of in (lambda m: mean(self.mean_of(*s, spp, m, "flip") for s in sequences),
                         lambda m: mean(self.relative_variance(s, spp, m) for s in sequences)):
            own, best = value_of("decoupled"), min((value_of(m), m) for m in others)
            row += [own, f"{text(best[0])} ({best[1]})", "holds" if own < best[0] else "missed"]
        return row

    def ghosts(self):
        found = {}
        for (data, animation, spp, method), rows in self.index.items():
            values = [float(r["ghost"]) for r in rows if r.get("ghost")]
            if values:
                found.setdefault((data, int(spp)), []).append([method] + values)
        return found

    def ablations(self):
        names = ["decoupled", "xu2024", *EXTRA, "decoupled-no-history"]
        sequences = [s for s in self.sequences() if any(self.compared(*s, self.spps()[0], EXTRA[0]))]
        header = ["method"] + [f"{', '.join(s)}, {spp} spp: PSNR / FLIP" for spp in self.spps() for s in sequences]
        rows = []
        for m in names:
            rows.append([m] + [f"{self.mean_of(*s, spp, m, 'psnr_db'):.2f} / {self.mean_of(*s, spp, m, 'flip'):.4f}"
                               for spp in self.spps() for s in sequences])
        return rows, header

    def classes(self):
        return [[r["data"], r["classes"], f"{100 * float(r['mean_absolute_error']):.2f} %", f"{100 * float(r['mean_error']):+.2f} %"]
                for r in self.read("classes.csv")]

    def part_datasets(self):
        return list(dict.fromkeys(r["data"] for r in self.read("classes.csv")))

    def sweeps(self):
        found = {}
        for r in self.read("sweep-*.csv"):
            found.setdefault(r["data"], []).append(r)
        return found

    def still(self):
        rows = self.read("still.csv")
        noisy = next((float(r["variance_sum"]) for r in rows if r["method"] == "noisy"), math.nan)
        return [[r["method"], float(r["psnr_db"]), float(r["flip"]), float(r["variance_sum"]) / noisy, 100 * float(r["spike_share"])] for r in rows]

    def write_summary(self):
        lines, markdown = [], []
        for spp in self.spps():
            rows = self.summary(spp)
            lines += [",".join(["spp", *(h.replace(",", "") for h in SUMMARY_HEADER)])] if not lines else []
            lines += [",".join([str(spp), *("" if v is None else str(v) for v in row)]) for row in rows]
            markdown += [f"{spp} samples a pixel:", "", "| " + " | ".join(SUMMARY_HEADER) + " |", "|" + "---|" * len(SUMMARY_HEADER)]
            markdown += ["| " + " | ".join(text(v) for v in row) + " |" for row in rows] + [""]
        for title, header, rows in self.goals():
            markdown += [title + ":", "", "| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
            markdown += ["| " + " | ".join(text(v) for v in row) + " |" for row in rows] + [""]
        (self.folder / "summary.csv").write_text("\n".join(lines) + "\n")
        (self.folder / "summary.md").write_text("\n".join(markdown))


def introduction(study):
    seconds = [line.split(",") for line in (study.folder / "seconds.csv").read_text().split()] if (study.folder / "seconds.csv").exists() else []
    total = sum(float(s) for _, s in seconds)
    settings = (study.folder / "settings.txt").read_text() if (study.folder / "settings.txt").exists() else ""
    taken = "; ".join(f"{html.escape(name)} {float(s) / 60:.1f}" for name, s in seconds)
    return (f"<p>{html.escape(settings)}</p><p class=dim>Took {total / 60:.1f} minutes ({taken}).</p>"
            "<p>Display values are linear values clamped to [0,1] and sRGB-encoded. All methods see the same frames and the same "
            "reprojection; the background is put behind after denoising for all of them, as xu2024 does for its own method alone.</p>")


REMARKS = """<h3>Where the ranks differ from the papers', and why</h3><ul>
<li><b>Temporal variance</b>: xu2024 has its own method steadiest. So it is here with its own temporal filters (the method xu2024), but then the history lags: eq. 13
gives the present 5 %, and a light that turns by 3 degrees a frame comes 20 frames late, so that at 30 spp its pictures are worse than the noisy ones. The decoupled method's own history is trusted as far as
it predicts the frame. Where light rests it is the steadiest of the others; where the area light turns and where the camera moves, SVGF is steadier and much farther from the truth.</li>
<li><b>FLIP at 30 spp</b>: the noisy picture is hardly worse than most. FLIP looks from 67 pixels a degree, where the eye blurs noise of single pixels away but not what
a filter removes.</li>
<li><b>wRLS against RLS</b>: the weights of iglesias2020 protect from spikes, of which scenes with wide lights and two scatterings have few; among narrow bands wRLS is
0.1 to 0.3 dB ahead at 1 and 2 spp. Elsewhere RLS is as good or better: a weight that is zero for dark samples costs a bias.</li>
<li><b>SVGF</b> ranks higher than in both papers where only the camera moves: here it knows the noise of normals, alpha is clamped to what the frame has, and the
background is no part of it, which is what the papers show it failing at. Where light moves it has the largest FLIP but for xu2024.</li>
<li><b>Fig. 7</b>: two classes are not free of visible error where matter is translucent: see “Classes”.</li>
<li><b>Convergence</b> at 30 spp does not tell the methods apart: at this size every method's consecutive pictures differ by less than 0.01 at once. At 2 spp decoupled, SVGF, A-SVGF and xu2024 do so within three frames, the others seldom.</li>
</ul>"""

NOT_REPRODUCED = """<h2>What is not reproduced</h2><ul>
<li>FDAE (xu2024) and RAE (iglesias2020): trained networks whose weights are not to be had here. Open Image Denoise stands in for the neural
methods where its library is found; it looks at each frame alone.</li>
<li>LPIPS: needs the weights of a pretrained network. FLIP, which needs none, takes its place.</li>
<li>The volumes of the papers (Manix, Macoessix, Anocelia, Smoke, Chameleon, Heloderma, Dragon): the head CT and the MRI take their place, the
Dragon's homogeneous matter is the skin of the head CT filled with one extinction.</li>
<li>The papers' split of light: fx of xu2024 depends on the direction of the light that a sample chose; here fx is the unshadowed shading by all
lights. Only the product of means over classes (Fig. 7) is computed the paper's way.</li>
<li>The history of 29 frames of xu2024 6.4.3 has 12 here, and 30 tests of 50 seeds are one test a sequence with fewer seeds unless --full:
the history is played anew for every seed.</li>
</ul>"""

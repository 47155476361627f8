#!/usr/bin/env python3
"""Makes one page, and the table for the documentation, of what voxlume_denoise_study left in a folder.

denoise_page.py FOLDER; leaves FOLDER/index.html, FOLDER/summary.csv and FOLDER/summary.md.
"""
import html
import pathlib
import sys

import denoise_tables as tables
import svg_plots as plots
from study_page import Page, table

COLOURS = """
.noisy{--c:#8b9096}.decoupled{--c:#d1493f}.svgf{--c:#3f7fc4}.xu2024{--c:#b07cc6}.asvgf{--c:#2aa3a3}.wrls{--c:#3d9950}.rls{--c:#9fb53a}
.atrous{--c:#8f62c4}.bilateral{--c:#c467ad}.oidn{--c:#d79a2b}.still{--c:#e58f87}.reference{--c:var(--dim)}
"""


def colour(method):
    return {"decoupled-no-history": "still", "decoupled-one-class": "atrous", "decoupled-no-decoupling": "bilateral",
            "wrls-no-feature": "wrls", "rls-no-feature": "rls"}.get(method, method)


def over_time(page, study):
    page.add("<h2>Over time</h2><p>Of the frames that were compared. In the tables above, “reference's own” is the PSNR that the reference itself has to "
             "the truth, from how far its two halves are apart.</p>")
    main = [m for m in study.methods() if not m.startswith("decoupled-")]
    page.key([(colour(m), m) for m in main])
    for data, animation in study.sequences():
        page.add(f"<h3>{html.escape(data)}, {html.escape(animation)}</h3>")
        made = []
        for spp in study.spps():
            for column, title in (("psnr_db", "PSNR"), ("flip", "FLIP"), ("ssim", "SSIM")):
                curves = [(colour(m), m, study.curve(data, animation, spp, m, column)) for m in main]
                made.append(plots.lines(f"{title}, {spp} spp", "dB" if title == "PSNR" else "", "frame",
                                        [c for c in curves if c[2]]))
        page.plots(made)
        shown = study.shown_frame(data, animation)
        for spp in study.spps():
            stem = f"{data}-{animation}-{shown:03d}"
            page.pictures([(f"{stem}-{spp}spp-{m}", f"{m}, {spp} spp, frame {shown}") for m in main + ["decoupled-no-history"]]
                          + [(f"{stem}-reference", "reference")])


def summary(page, study):
    for spp in study.spps():
        rows = study.summary(spp)
        page.add(f"<h3>{spp} samples a pixel, mean over {len(study.sequences(main=True))} sequences</h3>")
        page.add(table(tables.SUMMARY_HEADER, rows, {1: max, 3: min, 4: max, 5: min}))


def steadiness(page, study):
    page.add("<h2>Temporal variance and convergence</h2><p>Variance: sum over pixels of the variance of display values over pictures of one "
             "moment with different random numbers on the same history (xu2024 6.4.3), relative to that of the noisy pictures; one value a "
             "sequence. Convergence: seconds after everything stands still until the RMSE of consecutive pictures is below 0.01 "
             "(6.4.4); sequences in which it never was within the frames rendered are left out of the box and counted below.</p>")
    made = []
    for spp in study.spps():
        groups = [(colour(m), m, study.relative_variances(spp, m)) for m in study.steady_methods()]
        made.append(plots.boxes(f"variance, {spp} spp", "relative to noisy", groups, log=True))
    for spp in study.spps():
        groups = [(colour(m), m, study.convergence(spp, m)[0]) for m in study.steady_methods()]
        made.append(plots.boxes(f"convergence time, {spp} spp", "s", groups))
    page.plots(made)
    header = ["method"] + [f"{what}, {spp} spp" for spp in study.spps() for what in ("median frames", "median s", "never")]
    page.add(table(header, [[m] + [v for spp in study.spps() for v in study.convergence_row(spp, m)] for m in study.steady_methods()]))


def ghosts(page, study):
    found = study.ghosts()
    if not found:
        return
    page.add("<h2>Ghosting after an abrupt change</h2><p>Share of the picture before the change that is still in the picture, when soft "
             "matter vanishes at frame 60 (least squares, display values; 0 is none, negative is noise).</p>")
    for (data, spp), rows in found.items():
        page.add(f"<h3>{html.escape(data)}, {spp} spp</h3>" + table(["method", "frame 60", "61", "62", "63"], rows))


def ablations(page, study):
    page.add("<h2>Ablations of the decoupled denoiser</h2>"
             "<p>xu2024: with the temporal filters of the paper (eqs. 12 to 14). one-class: all samples of a pixel as one class. no-decoupling: all light in the part that is filtered like arriving light, "
             "so that nothing of high detail guides it but depth, normal and albedo. no-history: every frame by itself.</p>")
    rows, header = study.ablations()
    page.add(table(header, rows))


def parts(page, study):
    page.add("<h2>The parts of light (xu2024 Fig. 6)</h2><p>480 samples a pixel. fx: how the first scattering would look without shadows; "
             "fl: direct light over fx; later: emission and light of later scatterings. No environment behind.</p>")
    for data in study.part_datasets():
        page.pictures([(f"parts-{data}-{n}", f"{data}: {t}") for n, t in (
            ("fx-diffuse", "fx, diffuse"), ("fx-specular", "fx, specular"), ("fl-diffuse", "fl, diffuse"),
            ("fl-specular", "fl, specular"), ("later", "later"), ("all", "all light"))])
    page.add("<h3>Classes (Fig. 7)</h3><p>The paper multiplies the mean of fx by the mean of fl, class by class. A mean of products is not the product "
             "of means: the table has the error against the same samples' mean, for batches of 30 samples, relative to the mean radiance. "
             "voxlume stores the ratio of sums as fl instead: then the product is the mean, with any number of classes, and the error is 0.</p>")
    page.add(table(["data", "classes", "mean absolute error", "mean error"], study.classes()))
    for data in study.part_datasets():
        page.pictures([(f"classes-{data}-error-{k}", f"{data}: error of {k} class{'es' if k > 1 else ''}, times 10") for k in (1, 2, 3)])


def sweeps(page, study):
    found = study.sweeps()
    if not found:
        return
    page.add("<h2>Samples a pixel against frames a second and PSNR (xu2024 Fig. 9, iglesias2020 Figs. 16 and 17)</h2>"
             "<p>The last of eight frames of the orbit. Times are of this machine's processor, all cores, the picture's size as above.</p>")
    made = []
    for data, rows in found.items():
        methods = list(dict.fromkeys(r["method"] for r in rows))
        for column, title, unit in (("psnr_db", "PSNR", "dB"), ("frames_per_second", "frames a second", "1/s")):
            curves = [(colour(m), m, [(int(r["spp"]), float(r[column])) for r in rows if r["method"] == m]) for m in methods]
            made.append(plots.lines(f"{data}: {title}", unit, "samples a pixel", curves, log_x=True))
    page.key([(colour(m), m) for m in methods])
    page.plots(made)


def still(page, study):
    rows = study.still()
    if not rows:
        return
    page.add("<h2>A camera at rest (iglesias2020 Fig. 18)</h2><p>Thin bands, three scatterings: many spikes. 2 samples a pixel, frame 24 of a scene in which "
             "only the noise and the jitter of camera rays change. Flicker: variance over the last twelve frames, relative to noisy. "
             "Spikes: pixels off by more than 0.2 of the display's range.</p>")
    page.add(table(["method", "PSNR, dB", "FLIP", "flicker", "spikes, %"], rows, {1: max, 2: min, 3: min, 4: min}))
    page.pictures([("still-" + r[0], r[0]) for r in rows] + [("still-reference", "reference")])


def main():
    folder = pathlib.Path(sys.argv[1])
    study = tables.Study(folder)
    page = Page(folder, COLOURS)
    page.add(tables.introduction(study))
    page.add("<h2>Goals</h2>" + "".join(f"<h3>{html.escape(t)}</h3>" + table(h, r) for t, h, r in study.goals()))
    page.add("<h2>Summary</h2>")
    summary(page, study)
    page.add(tables.REMARKS)
    for part in (over_time, steadiness, ghosts, ablations, parts, sweeps, still):
        part(page, study)
    page.add(tables.NOT_REPRODUCED)
    page.write("Study of the denoisers")
    study.write_summary()


main()

"""The page about the demo."""

from __future__ import annotations

from html import escape
from typing import Any

from dwell.demo.plot import level_plot, line_plot

_STYLE = """
:root{color-scheme:light dark;--ink:#1d2430;--soft:#5a6575;--paper:#fbfaf8;--card:#fff;--line:#e2dfd9;
--accent:#1f7a6d;--warn:#c4532f}
@media(prefers-color-scheme:dark){:root{--ink:#e8e6e1;--soft:#a3a9b3;--paper:#15181d;--card:#1d2128;
--line:#323843;--accent:#54c2b0;--warn:#f08a63}}
*{box-sizing:border-box}body{margin:0;background:var(--paper);color:var(--ink);
font:16px/1.55 system-ui,sans-serif}main{max-width:1080px;margin:0 auto;padding:2rem 1.25rem 4rem}
h1{font-size:2rem;margin:.2rem 0}h2{margin:2.6rem 0 .6rem;font-size:1.35rem}p{max-width:72ch}
.soft{color:var(--soft)}.row{display:grid;grid-template-columns:repeat(3,1fr);gap:.6rem}
figure{margin:0 0 1.4rem;background:var(--card);border:1px solid var(--line);border-radius:10px;padding:.8rem}
img{width:100%;height:auto;border-radius:6px;display:block}figcaption{margin-top:.6rem}
table{border-collapse:collapse;width:100%}td,th{text-align:left;padding:.35rem .6rem;
border-bottom:1px solid var(--line);vertical-align:top}.yes{color:var(--accent);font-weight:600}
.no{color:var(--warn);font-weight:600}audio{width:100%;margin:.6rem 0}.two{display:grid;
grid-template-columns:1fr 1fr;gap:1rem;align-items:start}@media(max-width:720px){.two,.row{grid-template-columns:1fr}}
svg{width:100%;height:auto}svg text{fill:var(--soft);font-size:11px}.axis{stroke:var(--line)}
.before{fill:var(--warn)}.after{fill:var(--accent)}
.line{fill:none;stroke-width:1.5}.before.line{stroke:var(--warn)}.after.line{stroke:var(--accent)}
"""


def _mark(success: bool) -> str:
    return '<span class="yes">yes</span>' if success else '<span class="no">no</span>'


def _done(line: dict[str, Any]) -> str:
    """Yes or no; nothing where there was nothing to do."""
    return "" if line["code"] == "none" else _mark(line["success"])


def _rooms(story: dict[str, Any]) -> str:
    figures = []
    for room in story["rooms"]:
        images = "".join(
            f'<img src="{file}" alt="{escape(room["title"])}, {channel}" loading="lazy">'
            for channel, file in room["files"].items()
        )
        figures.append(
            f'<figure><div class="row">{images}</div><figcaption><strong>{escape(room["title"])}</strong> '
            f'<span class="soft">{escape(room["name"])}</span><br>{escape(room["text"])}</figcaption></figure>'
        )
    return "".join(figures)


def _instruction(told: dict[str, Any]) -> str:
    if "refused" in told:
        return f"<p>No instruction could be given: {escape(told['refused'])}</p>"
    return (
        f'<div class="two"><figure><img src="{told["film"]}" alt="what the agent saw"></figure><div>'
        f"<p><strong>{escape(told['text'])}</strong></p><p>Fulfilled: {_mark(told['success'])}, "
        f"checked by the same predicates that made the sentence. {told['steps']} control steps, "
        f"success weighted by path length {told['spl']:.2f}.</p></div></div>"
    )


def _errand(errand: dict[str, Any]) -> str:
    rows = "".join(
        f"<tr><td>{line['time_s']} s</td><td>{escape(line['what'])}</td><td>{_done(line)}</td>"
        f"<td>{escape(line['sentence'])}</td></tr>"
        for line in errand["log"]
    )
    level = errand["level_db"]
    loudness = (
        "Nothing sounded on the way: the recording is silent."
        if level is None
        else f"{level} dB SPL on average. Wear headphones."
    )
    return (
        f'<div class="two"><figure><img src="{errand["film"]}" alt="what the agent saw"></figure>'
        f'<figure><img src="map.png" alt="the house from above with the ways"></figure></div>'
        f"<table><tr><th>when</th><th>what</th><th>done</th><th>said</th></tr>{rows}</table>"
        f"<h2>What it heard</h2><p>Both ears of a spherical head, traced through the rooms. {loudness}</p>"
        f'<audio controls src="{errand["wav"]}"></audio>'
        f'<figure><img src="{errand["spectrogram"]}" alt="spectrogram of both ears"></figure>'
    )


def _side(left_deg: float) -> str:
    """A direction in words: ``63 degrees to the left``."""
    return f"{abs(left_deg):.0f} degrees to the {'left' if left_deg >= 0 else 'right'}"


def _second_agent(told: dict[str, Any]) -> str:
    """When the other was heard and seen first, out of what was measured."""
    if "refused" in told:
        return f"<p>No second agent: {escape(told['refused'])}</p>"
    heard, seen = told["heard"], told["seen"]
    marks, sentences = [], []
    if heard is None:
        sentences.append("No word of it was heard.")
    else:
        word = (
            f"\u201c{heard['word']}\u201d" if heard["word"] else "a word that it did not understand"
        )
        marks.append((heard["time_s"], "heard first"))
        sentences.append(
            f"Heard first after {heard['time_s']:g} s: {word}, {heard['level_db']:g} dB SPL, from "
            f"{_side(heard['left_deg'])}, with {heard['pixels']} pixels of it in view."
        )
    if seen is None:
        sentences.append("It did not come into view.")
    else:
        marks.append((seen["time_s"], "seen first"))
        sentences.append(
            f"Seen first after {seen['time_s']:g} s: {seen['pixels']} pixels of the instance mask."
        )
    plot = level_plot(told["levels_db"], told["step_s"], marks)
    return (
        f'<div class="two"><figure><img src="{told["film"]}" alt="what the first agent saw"></figure><div>'
        f"<p>Another agent comes from a room out of sight and says \u201c{escape(told['words'])}\u201d, over "
        f"and over. The first stands and turns to where its ears tell it that the words come from.</p>"
        f"<p><strong>{escape(' '.join(sentences))}</strong></p></div></div><figure>{plot}<figcaption "
        "class='soft'>Level at the left (orange) and the right ear (green), dB SPL.</figcaption></figure>"
    )


def _calibration(found: dict[str, Any]) -> str:
    plots = "".join(
        f"<figure>{line_plot(plot['title'], plot['unit'], plot['before'], plot['after'])}</figure>"
        for plot in found["plots"][:2]
    )
    return (
        f"<p>Throws were simulated by another program, with something hidden: "
        f"<em>{escape(found['hidden'])}</em></p><p><strong>{escape(found['sentence'])}</strong></p>"
        f'<div class="two">{plots}</div><p class="soft">Residuals before (orange) and after (green) the '
        f'named law was added. <a href="{found["page"]}">The whole report</a></p>'
    )


def _words(key: str) -> str:
    """The name of a figure: ``impulse_responses_per_s_rl`` as people write it."""
    what, per, which = key.partition("_per_s")
    what = what.replace("_", " ") + (" per second" if per else "")
    return f"{what} ({which.strip('_').replace('_', ' ')})" if which else what


def _figures(figures: dict[str, Any]) -> str:
    rows = []
    for stage, values in figures.items():
        cells = ", ".join(
            f"{_words(key)} {value:.4g}" if isinstance(value, float) else f"{_words(key)} {value}"
            for key, value in values.items()
            if not isinstance(value, list)
        )
        rows.append(f"<tr><td>{stage}</td><td>{escape(cells)}</td></tr>")
    return f"<table>{''.join(rows)}</table>"


def html(story: dict[str, Any]) -> str:
    """The page; ``story`` is what the parts of the demo returned."""
    info = story["info"]
    recording = story["recording"]
    viewer = (
        f'<p><a href="{recording["file"]}">A recording</a> for the Rerun viewer.</p>'
        if "file" in recording
        else f'<p class="soft">{escape(recording["missing"])}</p>'
    )
    text = "".join(
        f"<p>{escape(part)}</p>" for part in "\n".join(story["text"]).split("\n") if part
    )
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>dwell: {escape(story['house'])}</title><style>{_STYLE}</style></head><body><main>"
        f'<p class="soft">dwell demo</p><h1>{escape(story["house"])}</h1>'
        f"<p>{len(info['rooms'])} rooms, {info['objects']} objects, {info['triangles']:,} triangles, "
        f"{info['lights']} lights, {info['emitters']} sources of sound.</p>"
        '<figure><img src="dollhouse.png" alt="the house from outside, cut open"></figure>'
        f"<h2>Every room</h2>{_rooms(story)}"
        f"<h2>The house in words</h2>{text}"
        f"<h2>An instruction</h2>{_instruction(story['instruction'])}"
        f"<h2>An errand</h2>{_errand(story['errand'])}"
        f"<h2>A second agent</h2>{_second_agent(story['second_agent'])}{viewer}"
        f"<h2>A hidden error, found</h2>{_calibration(story['calibration'])}"
        f"<h2>How fast</h2><p class='soft'>Short runs on this machine, beside everything else.</p>"
        f"{_figures(story['figures'])}</main></body></html>"
    )

"""Reports stand by themselves, and show what they are given, as text."""

import re
from html.parser import HTMLParser

import numpy as np
import pytest

from mooring_ros.offline import plots, report


class Reader(HTMLParser):
    """Collects attributes that could load something, and whether tags balance."""

    def __init__(self):
        super().__init__()
        self.references, self.open, self.text = [], [], ""

    def handle_starttag(self, tag, attributes):
        self.references += [value for name, value in attributes if name in ("src", "href", "xlink:href", "data", "action")]
        if tag not in ("meta", "br", "link"):
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.references += [value for name, value in attributes if name in ("src", "href", "xlink:href", "data", "action")]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def read(text):
    reader = Reader()
    reader.feed(text)
    assert not reader.open
    return reader


def figures():
    times = np.linspace(0.0, 30.0, 301)
    pose = np.zeros((301, 7))
    pose[:, 0], pose[:, 6] = np.sin(times), 1.0
    series = {"line1": 1e6 + 1e5 * np.sin(times), "a<b&c": 1e6 + 0.0 * times}
    shape = np.stack([np.linspace(-800, -40, 21), np.zeros(21), np.linspace(-200, -14, 21)], axis=1)
    return {
        "motion": plots.motion_figure(times, pose),
        "tension": plots.tension_figure(times, series),
        "overlay": plots.overlay_figure(times, series["line1"], series["a<b&c"], "line1"),
        "scatter": plots.scatter_figure({name: (values, values) for name, values in series.items()}),
        "spectra": plots.spectra_figure(times, series),
        "shapes": plots.line_shapes_figure({"line1": (shape, np.linspace(1e6, 2e6, 21))}, 200.0),
    }


@pytest.mark.parametrize("name,figure", figures().items(), ids=lambda value: value if isinstance(value, str) else "")
def test_every_figure_goes_into_a_report_that_loads_nothing(name, figure, tmp_path):
    path = tmp_path / "report.html"
    report.write_report(path, "A report", [report.Section(name, report.figure(figure, "its caption"))])
    text = path.read_text(encoding="utf-8")
    assert all(reference.startswith(("#", "data:")) for reference in read(text).references)
    assert not re.search(r"https?:|@import|url\((?!#)", text)
    assert "<svg" in text and "its caption" in text


def test_texts_are_escaped_everywhere():
    hostile = "<script>alert('&')</script>"
    html = report.document(hostile, [report.Section(hostile, report.paragraph(hostile) + report.table([hostile], [[hostile]], hostile))])
    assert "<script" not in html
    assert read(html).text.count(hostile) == 7  # title, h1, h2, paragraph, caption, header, cell


def test_a_row_of_the_wrong_length_is_refused():
    with pytest.raises(ValueError, match="a row of 1 cells in a table of 2 columns"):
        report.table(["a", "b"], [["1"]])


def test_numbers_stand_on_the_right_and_nothing_is_a_dash():
    html = report.table(["name", "value"], [["x", 1.0], ["y", None], ["z", "−3.5 %"]])
    assert html.count('<td class="number">') == 3 and "–" in html
    assert '<td>x</td>' in html


def test_the_same_report_is_the_same_bytes(tmp_path):
    texts = [report.document("t", [report.Section("s", report.figure(figures()["tension"], "c"))]) for _ in range(2)]
    assert texts[0] == texts[1]


def test_a_long_history_keeps_its_extremes_when_thinned():
    times = np.linspace(0.0, 1.0, 200_001)
    values = np.zeros(len(times))
    values[123_457], values[77_777] = 5.0, -7.0
    line = plots.tension_figure(times, {"a": values}).axes[0].lines[0]
    drawn = line.get_ydata()
    assert len(drawn) < 4000 and drawn.max() == 5.0 and drawn.min() == -7.0


def test_the_amplitude_spectrum_shows_the_amplitude_of_a_sine():
    times = np.arange(0.0, 100.0, 0.1)
    frequency, amplitude = plots.amplitude_spectrum(times, 7.0 + 3.0 * np.sin(2.0 * np.pi * 0.2 * times))
    assert frequency[amplitude.argmax()] == pytest.approx(0.2)
    assert amplitude.max() == pytest.approx(3.0, rel=1e-3)

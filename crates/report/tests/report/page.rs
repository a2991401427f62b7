//! Pages of every kind of part.

use apportion_report::chart::{Axis, Chart, Colour, Panel, Point, Series, Shape};
use apportion_report::document::{Cell, Document, Figure, Link, Mark, OnPhone, Part, Section, Table};
use apportion_report::{Artefacts, ChartFormat};

fn scatter(title: &str) -> Chart {
    let point = Point { x: 1.0, y: 2.0, label: "a point".to_owned() };
    let marks = [Series::new("s", Colour::Series(0)).mark(Shape::Point(point))];
    Chart::new(title, "One point.").panels([Panel::new(Axis::default(), Axis::default()).with(marks)])
}

fn small(id: &str, chart: Chart) -> Figure {
    Figure {
        id: id.to_owned(),
        label: "Figure 1".to_owned(),
        title: None,
        comparison_note: String::new(),
        chart,
        stem: format!("{id}-chart"),
        data: "data.csv".to_owned(),
    }
}

fn figure(id: &str, chart: Chart) -> Part {
    small(id, chart).into()
}

fn page(parts: Vec<Part>) -> Document {
    Document {
        name: "page".to_owned(),
        kicker: "Test".to_owned(),
        title: "A page".to_owned(),
        lead: vec!["The lead.".to_owned()],
        sections: vec![Section::new("one", "One", parts), Section::new("two", "Two", Vec::new())],
        footer: "The end.".to_owned(),
        charts: Vec::new(),
        files: Vec::new(),
    }
}

/// A part of every kind, with `text` at every place for text.
fn every_part(text: &str) -> Vec<Part> {
    let t = || text.to_owned();
    vec![
        Part::Text(t()),
        Part::Heading(t()),
        Part::List(vec![t()]),
        Part::Code(t()),
        Part::Links(vec![Link { text: t(), to: t() }]),
        Part::Notice { mark: Mark::Mixed, kind: t(), texts: vec![t()] },
        Part::Frame { title: t(), html: t() },
        Part::Details { summary: t(), parts: vec![figure("f1", scatter(text))] },
        Part::Gallery(vec![small("f2", scatter(text))]),
        Part::Table(Table {
            on_phone: OnPhone::StackLabelled,
            ..Table::from_rows(t(), [Mark::Plain, Mark::Good, Mark::Strong])
                .text(t(), |mark| Cell::marked(t(), mark))
                .number(t(), |_| Cell {
                    text: t(),
                    mark: Mark::Bad,
                    to: Some(t()),
                    note: t(),
                    links: vec![Link { text: t(), to: t() }],
                    ..Cell::default()
                })
                .into()
        }),
    ]
}

/// The start tags of a document, unchanged.
fn tags(html: &str) -> Vec<&str> {
    html.split('<').skip(1).filter_map(|rest| rest.split_once('>')).map(|(tag, _)| tag).collect()
}

#[test]
fn the_page_needs_no_other_files() {
    let html = page(every_part("words")).html();
    let own = html.replace("http://www.w3.org/2000/svg", "");
    for outside in ["http:", "https:", " src=", "@import", "url(", "//cdn", "fetch("] {
        assert!(!own.contains(outside), "{outside}");
    }
    assert_eq!(html.matches("<svg").count(), 3, "one chart drawn twice, and a small one once");
    assert!(!html.contains("f2-wide") && html.contains("aria-labelledby=\"f2-narrow-title\""));
    assert!(
        html.contains("</div>\n<p class=\"on-paper\">On the screen, there is an animation here: words.</p>"),
        "{html}"
    );
    assert!(html.contains("aria-labelledby=\"f1-wide-title\"") && html.contains("id=\"f1-narrow-desc\""));
    assert!(html.contains("<a href=\"#two\">Two</a>"));
    assert!(html.contains("<span class=\"badge good\"><span aria-hidden=\"true\">✓</span> words</span>"), "{html}");
}

#[test]
fn links_are_separated_from_numbers() {
    let cell = Cell { links: vec![Link::new("fig. 8", "#two")], ..Cell::from("1") };
    let table = Table::from_rows("Claims.", [&cell]).text("claim", Cell::clone);
    let html = page(vec![table.into()]).html();
    assert!(html.contains("1 <span class=\"files\">"), "{html}");
    // Chromium draws a heading that repeats on paper, but no button in it.
    assert!(html.contains("thead button { display: contents; }"));
}

#[test]
fn texts_cannot_break_out() {
    let evil = "</script></style></title><script>alert('&\"')</script><!--\" onload=\"x\u{0}";
    let mut evil_page = page(every_part(evil));
    (evil_page.kicker, evil_page.title, evil_page.footer) = (evil.to_owned(), evil.to_owned(), evil.to_owned());
    evil_page.lead = vec![evil.to_owned()];
    evil_page.sections[0].title = evil.to_owned();
    let html = evil_page.html();
    let tame = page(every_part("tame")).html();
    let names = |html: &str| -> Vec<String> {
        tags(html).iter().map(|tag| tag.split([' ', '\n']).next().unwrap_or_default().to_owned()).collect()
    };
    // The chart breaks its texts into lines by their length: its elements are not tested here.
    let drawn = ["text", "/text", "g", "/g", "line", "rect"];
    let frame = |names: Vec<String>| names.into_iter().filter(|n| !drawn.contains(&n.as_str())).collect::<Vec<_>>();
    assert_eq!(frame(names(&html)), frame(names(&tame)));
    assert!(!html.contains(['\u{0}']) && !html.contains(" onload=\"x"));
    assert_eq!(html.matches("</script>").count(), 1);
}

#[test]
fn the_same_page_gives_the_same_bytes() {
    let bytes = || page(every_part("F_cr = 5 nN")).html();
    assert_eq!(bytes(), bytes());
}

#[test]
fn a_page_links_only_to_files_in_its_folder() {
    let document = page(vec![figure("f1", scatter("a"))]);
    let alone = document.html();
    assert!(!alone.contains(".svg\"") && !alone.contains(".csv\""));
    let folder = tempfile::tempdir().unwrap();
    let written =
        Artefacts { formats: vec![ChartFormat::Svg], ..Artefacts::new(folder.path()) }.write(&document).unwrap();
    let beside = std::fs::read_to_string(written.page).unwrap();
    assert!(beside.contains("href=\"charts/f1-chart.svg\"") && beside.contains("href=\"data.csv\""), "{beside}");
    assert!(!beside.contains(".png"));
}

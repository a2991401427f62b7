//! Line breaks, shortening and escaping of texts, and the numbers in a chart.

use resvg::usvg::roxmltree::Document;

use super::reading::{groups, texts, texts_of_size, width};
use super::*;

/// Width of the text of a figure on a phone, px.
const ROOM: f64 = 360.0 - 2.0 * 12.0;

/// The lines of a caption on a phone.
fn lines(caption: &str) -> Vec<String> {
    let svg = Chart::new("", caption).svg_at(ChartWidth::Narrow);
    let document = Document::parse(&svg).expect("well-formed");
    texts(groups(&document, "caption")[0]).into_iter().map(str::to_owned).collect()
}

#[test]
fn wraps_at_spaces_and_inside_long_words_only() {
    assert_eq!(lines(" surface  energy\nof tip "), ["surface energy of tip"]);
    let (word, long) = ("0".repeat(40), "0".repeat(54));
    assert_eq!(lines(&format!("{word} {word} 00")), [word.clone(), format!("{word} 00")]);
    assert_eq!(lines(&format!("{long}0")), [long, "0".to_owned()]);
    assert!(lines(" \n").is_empty());
}

#[test]
fn letters_have_the_widths_of_arial() {
    // A bold "b" has 1251 of 2048 units, so 81 of 14 px fit into 696 px.
    let svg = Chart::new("b".repeat(82), "").svg();
    let document = Document::parse(&svg).expect("well-formed");
    assert_eq!(texts(groups(&document, "title")[0]), ["b".repeat(81).as_str(), "b"]);
}

/// The name of a row as written next to its bar on a page, and its tooltip.
fn named(name: &str) -> (String, Option<String>) {
    let rows = Axis::from_names("", vec![name.to_owned()]);
    let svg = svg(vec![Panel::new(Axis::new("", ""), rows).with([series(0).mark(Shape::Bar(Bar::default()))])]);
    let document = Document::parse(&svg).expect("well-formed");
    let is_name = |node: &resvg::usvg::roxmltree::Node| node.attribute("text-anchor") == Some("end");
    let name = document.descendants().find(is_name).expect("a name");
    let tip = name.children().find(|node| node.has_tag_name("title")).and_then(|node| node.text());
    (name.text().unwrap_or_default().to_owned(), tip.map(str::to_owned))
}

#[test]
fn shortens_with_an_ellipsis() {
    assert_eq!(named("tip radius"), ("tip radius".to_owned(), None));
    // 220 px.
    let long = "0".repeat(1_000_000);
    let (shown, tip) = named(&long);
    assert!(shown == "0".repeat(35) + "…" && tip.is_some_and(|tip| tip == long), "{shown}");
    assert_eq!(named(&format!("{} WWWWW", "0".repeat(34))).0, "0".repeat(34) + "…");
    assert_eq!(named("").0, "");
    // Names of columns without any room.
    let columns = Axis::from_names("", (0..100).map(|number| format!("x{number}")).collect());
    let svg = svg(vec![Panel::new(columns, Axis::new("", "")).with([series(0).line(vec![(0.0, 0.0)])])]);
    let document = Document::parse(&svg).expect("well-formed");
    let names = texts_of_size(groups(&document, "x-axis")[0], "10.5");
    assert!(names.len() == 100 && names.iter().all(|(_, name)| *name == "…"), "{names:?}");
}

#[test]
fn numbers_read_as_in_print() {
    let label = |value: f64| Bar::percent(0, Some(value), None).label;
    assert_eq!(label(46.05), "46.0");
    assert_eq!(label(-0.5), "\u{2212}0.5");
    assert_eq!(label(-0.04), "0.0");
    assert_eq!(label(-1e300), "\u{2212}1.0e300");
}

/// The elements of the text of a chart whose horizontal axis has this title.
fn written(title: &str) -> String {
    let svg = svg(vec![Panel::new(Axis::new(title, ""), Axis::new("", "")).with([series(0).line(vec![(0.0, 0.0)])])]);
    let (_, axis) = svg.split_once("class=\"x-axis\"").expect("an axis");
    let (_, text) = axis.split_once("font-size=\"11\" text-anchor=\"middle\">").expect("a title");
    text.split_once("</text>").expect("an end").0.to_owned()
}

#[test]
fn symbols_have_lowered_subscripts() {
    let lowered = |text: &str| format!("<tspan dy=\"2.42\" font-size=\"8.25\">{text}</tspan>");
    let raised = |text: &str| format!("<tspan dy=\"-2.42\">{text}</tspan>");
    assert_eq!(written("F_cr"), format!("F{}", lowered("cr")));
    let expected = format!("(S{}{}K{}{}", lowered("T"), raised(", "), lowered("θ"), raised(")"));
    assert_eq!(written("(S_T, K_theta)"), expected);
    assert_eq!(written("my_file < 2"), "my_file &lt; 2");
}

proptest! {
    #[test]
    fn wrapping_keeps_every_character(text in "\\PC{0,60}") {
        // Symbols are in parts.
        let text = text.replace('_', " ");
        let kept: String = lines(&text).concat().split_whitespace().collect();
        prop_assert_eq!(kept, text.split_whitespace().collect::<String>());
    }

    #[test]
    fn lines_are_as_long_as_there_is_room(text in "[0W.]{1,70}( [0W.]{1,70}){0,9}") {
        let lines = lines(&text);
        let kept: String = lines.concat().split_whitespace().collect();
        prop_assert_eq!(kept, text.replace(' ', ""));
        for line in &lines {
            prop_assert!(width(line, 11.0) <= ROOM, "{}", line);
        }
        for pair in lines.windows(2) {
            let word = pair[1].split(' ').next().unwrap();
            let (is_broken, next) = (!text.contains(&format!("{} {word}", pair[0])), &word[..1]);
            // A word that is itself broken did not fit as a whole.
            let whole = text.split(' ').filter(|of| of.starts_with(word)).max_by_key(|of| of.len()).unwrap_or(word);
            let joined = if is_broken { format!("{}{next}", pair[0]) } else { format!("{} {whole}", pair[0]) };
            prop_assert!(width(&joined, 11.0) > ROOM, "{:?}", lines);
        }
    }

    #[test]
    fn any_text_survives_as_text(text in any::<String>()) {
        // Symbols are in parts; XML forbids the last characters.
        let text = text.replace('_', " ") + "\u{1f}\u{ffff}";
        let bar = Bar { to: 1.0, label: text.clone(), value_text: text.clone(), ..Bar::default() };
        let panel = Panel::new(Axis::new("", ""), Axis::from_names("", vec!["row".to_owned()]));
        let chart = Chart::new(&text, "").panels([panel.with([series(0).mark(Shape::Bar(bar))])]);
        let expected: String = text
            .chars()
            .map(|c| if c.is_control() && c < ' ' && c != '\t' && c != '\n'
                || c == '\u{fffe}' || c == '\u{ffff}' { '\u{fffd}' } else { c })
            .collect();
        let svg = chart.svg();
        let document = Document::parse(&svg).expect("well-formed");
        let values = texts(groups(&document, "values")[0]);
        prop_assert_eq!(values.first().copied().unwrap_or_default(), &expected);
        let title = document.root_element().first_element_child().and_then(|node| node.text());
        prop_assert_eq!(title.unwrap_or_default(), &expected);
        let tip = groups(&document, "bars")[0].descendants().find(|node| node.has_tag_name("title")).unwrap().text();
        prop_assert!(tip.unwrap_or_default().ends_with(&expected));
        // Its title is an attribute too.
        Document::parse(&chart.inline(ChartWidth::Narrow, "id")).expect("well-formed");
    }
}

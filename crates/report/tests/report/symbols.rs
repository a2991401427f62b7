//! Text on a page: symbols with subscripts, code, and targets of links.

use apportion_report::document::{Document, Link, Part, Section, symbols};

#[test]
fn symbols_have_subscripts() {
    let cases = [
        ("F_cr", "<var>F</var><sub>cr</sub>"),
        ("F_Y*", "<var>F</var><sub>Y</sub>*"),
        ("S_T of K_y, z_P0.", "<var>S</var><sub>T</sub> of <var>K</var><sub>y</sub>, <var>z</var><sub>P0</sub>."),
        ("(S_1)", "(<var>S</var><sub>1</sub>)"),
        ("S_1/S_T", "<var>S</var><sub>1</sub>/<var>S</var><sub>T</sub>"),
        ("K_theta", "<var>K</var><sub>θ</sub>"),
        ("σ_0", "<var>σ</var><sub>0</sub>"),
        ("ln F_cr-", "ln <var>F</var><sub>cr</sub>-"),
    ];
    for (text, html) in cases {
        assert_eq!(symbols(text), html, "{text}");
    }
}

#[test]
fn names_stay_names() {
    for text in [
        "my_file",
        "critical_force",
        "x_1.csv",
        "a_b_c",
        "f_model-run",
        "dir.F_cr",
        "run-x_1",
        "x_elastic",
        "F_",
        "_x",
        "m2",
        "J/m2",
        "4_x",
        "S_1x9zz",
    ] {
        assert_eq!(symbols(text), text);
    }
}

#[test]
fn code_is_not_changed() {
    assert_eq!(symbols("set `F_cr = 5 nN`, `<b>`"), "set <code>F_cr = 5 nN</code>, <code>&lt;b&gt;</code>");
    assert_eq!(symbols("a lone ` and ``"), "a lone ` and ``");
}

#[test]
fn nothing_breaks_out() {
    let evil = "</script><script>alert('&\"')</script><!--\u{0}\u{1b}[31m\u{202e}";
    let html = symbols(evil);
    assert!(!html.contains(['<', '>', '"', '\'', '\u{0}', '\u{1b}', '\u{202e}']), "{html}");
    assert!(html.starts_with("&lt;/script&gt;&lt;script&gt;alert(&#39;&amp;&quot;&#39;)"), "{html}");
    assert!(!symbols("`</code><b>` F_<b>").contains("<b>"));
}

#[test]
fn links_stay_within_the_folder_of_the_page() {
    let cases = [
        ("shares.csv", "shares.csv"),
        ("a b/µ.svg", "a%20b/%C2%B5.svg"),
        ("#claims", "#claims"),
        ("javascript:alert(1)", "javascript%3Aalert%281%29"),
        ("//example.org/x", "example.org/x"),
        ("\"><script>", "%22%3E%3Cscript%3E"),
    ];
    let links = cases.iter().map(|(to, _)| Link::new("a file", *to)).collect();
    let document =
        Document { sections: vec![Section::new("one", "One", vec![Part::Links(links)])], ..Document::default() };
    let html = document.section_html("one").unwrap();
    let drawn: Vec<&str> = html.split("href=\"").skip(1).filter_map(|rest| Some(rest.split_once('"')?.0)).collect();
    assert_eq!(drawn, cases.map(|(_, href)| href));
}

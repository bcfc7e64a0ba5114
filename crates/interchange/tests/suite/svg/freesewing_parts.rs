//! Parts as FreeSewing draws them in other ways than most: small drawings by hand.

use crate::svg::drawings::{is_near, one, shapes};
use crate::svg::read;
use toile_pattern::{LineKind, Number};

/// A drawing of parts, in mm, each with its name and the lines in it.
fn drawing(parts: &[(&str, &str)]) -> String {
    let part = |(name, lines): &(&str, &str)| {
        format!("<g id='fs-stack-{name}'><g id='fs-stack-{name}-part-{name}'>{lines}</g></g>")
    };
    let parts: String = parts.iter().map(part).collect();
    let styles = "<style>svg.freesewing path { fill: none; stroke: #000 } svg.freesewing .hidden { stroke: none; fill: none }</style>";
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' class='freesewing' width='2000mm' height='2000mm' viewBox='0 0 2000 2000'>{styles}<g id='fs-container'>{parts}</g></svg>"
    )
}

const SEAM: &str = "M0 0H200V300H0z";

#[test]
fn a_sew_line_without_the_class_of_a_material_is_one() {
    for class in ["", "class=''", "class='class'", "class='stroke-lg'"] {
        let lines = format!(
            "<path {class} d='{SEAM}'/><path d='M20 20H60'/><path class='fabric dashed' d='M50 50H150V150H50z'/><path class='fabric sa' d='M-10 -10H210V310H-10z'/>"
        );
        let reading = read(&drawing(&[("top.front", &lines)])).unwrap();
        let (name, area, _) = one(&reading);
        assert_eq!(name, "front", "{class}");
        is_near(area, 0.06, 1e-9);
        let panel = &reading.pattern.panels[0];
        assert_eq!(panel.allowance, Number::from(0.01), "{class}");
        let inner = panel.lines.iter();
        let inner = inner.filter(|line| line.kind == LineKind::Internal);
        assert_eq!(inner.count(), 2, "{class}");
    }
    // Lines of a material come first, though others go round more.
    let lines = format!("<path d='M-50 -50H250V350H-50z'/><path class='fabric' d='{SEAM}'/>");
    let (_, area, _) = one(&read(&drawing(&[("top.front", &lines)])).unwrap());
    is_near(area, 0.06, 1e-9);
}

#[test]
fn an_allowance_of_another_material_or_of_none_is_one() {
    let cut = "M-10 -10H210V310H-10z";
    for (seam, allowance) in [
        ("fabric", "sa"),
        ("lining", "fabric sa"),
        ("canvas", "sa various"),
    ] {
        let lines =
            format!("<path class='{seam}' d='{SEAM}'/><path class='{allowance}' d='{cut}'/>");
        let reading = read(&drawing(&[("top.front", &lines)])).unwrap();
        let panel = &reading.pattern.panels[0];
        assert_eq!(panel.allowance, Number::from(0.01), "{seam}, {allowance}");
    }
    // The one of the own material is taken where there are two.
    let lines = format!(
        "<path class='fabric' d='{SEAM}'/><path class='lining sa' d='M-20 -20H220V320H-20z'/><path class='fabric sa' d='{cut}'/>"
    );
    let reading = read(&drawing(&[("top.front", &lines)])).unwrap();
    assert_eq!(reading.pattern.panels[0].allowance, Number::from(0.01));
    assert_eq!(shapes(&reading.pattern).len(), 1);
}

#[test]
fn a_file_without_its_styles_is_known_by_the_version_it_states() {
    let text = drawing(&[("top.front", &format!("<path class='fabric' d='{SEAM}'/>"))]);
    let text = text.replace("class='freesewing'", "freesewing='4.10.2'");
    assert_eq!(one(&read(&text).unwrap()).0, "front");
}

#[test]
fn an_allowance_that_is_left_open_at_a_corner_goes_round() {
    let cut = "M195 -10H-10V330H210V-10H198";
    let lines = format!("<path class='fabric' d='{SEAM}'/><path class='fabric sa' d='{cut}'/>");
    let reading = read(&drawing(&[("top.front", &lines)])).unwrap();
    let panel = &reading.pattern.panels[0];
    assert_eq!(panel.allowance, Number::from(0.01));
    let others: Vec<Number> = panel
        .edges()
        .filter_map(|edge| edge.allowance.clone())
        .collect();
    assert_eq!(others, [Number::from(0.03)], "the hem alone");
}

#[test]
fn words_with_bare_ampersands_are_read_and_told() {
    let lines =
        format!("<path class='fabric' data-text='&amp; &' d='{SEAM}'/><text>left & right</text>");
    let reading = read(&drawing(&[("top.front", &lines)])).unwrap();
    assert_eq!(one(&reading).0, "front");
    let told = reading.losses.iter().find(|loss| loss.what.contains('&'));
    assert_eq!(told.unwrap().count, 2);
    // Other faults are still told.
    assert!(read(&drawing(&[("top.front", "<text>& </g>")])).is_err());
}

//! Icons of the tools, drawn in a few strokes on a square of 20 units, y downward.

use egui::epaint::{CircleShape, CubicBezierShape};
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke};

/// Side of the square that icons are drawn on (units).
const SIDE: f32 = 20.0;
/// Stroke width (units).
const WIDTH: f32 = 1.4;
/// Length of dashes, and of the gaps between them (units).
const DASH: [f32; 2] = [2.2, 1.6];

/// A point on the square (units).
type Place = (f32, f32);

/// A stroke of an icon.
enum Stroked {
    /// A polyline.
    Line(&'static [Place]),
    /// A dashed polyline.
    Dashed(&'static [Place]),
    /// A filled polygon.
    Filled(&'static [Place]),
    /// A cubic curve.
    Curve([Place; 4]),
    /// A disc: a point that exists already.
    Dot(Place),
    /// A ring: a point that the tool makes.
    Ring(Place),
}

use Stroked::{Curve, Dashed, Dot, Filled, Line, Ring};

/// Strokes of the icon for a tool's command; empty for a command without an icon.
fn strokes(command: &str) -> &'static [Stroked] {
    match command {
        "Select" => &[Filled(&[
            (5.0, 2.0),
            (5.0, 16.0),
            (8.6, 12.8),
            (10.8, 18.0),
            (13.2, 17.0),
            (11.0, 12.0),
            (15.4, 11.6),
        ])],
        "Point" => &[
            Dot((10.0, 10.0)),
            Line(&[(10.0, 2.5), (10.0, 6.5)]),
            Line(&[(10.0, 13.5), (10.0, 17.5)]),
            Line(&[(2.5, 10.0), (6.5, 10.0)]),
            Line(&[(13.5, 10.0), (17.5, 10.0)]),
        ],
        "Line" => &[
            Line(&[(3.5, 16.5), (16.5, 3.5)]),
            Dot((3.5, 16.5)),
            Dot((16.5, 3.5)),
        ],
        "Curve" => &[
            Curve([(3.0, 15.0), (6.0, -2.0), (13.0, 22.0), (17.0, 5.0)]),
            Dot((3.0, 15.0)),
            Dot((17.0, 5.0)),
        ],
        "Arc" => &[
            Curve([(3.0, 15.0), (3.0, 3.0), (17.0, 3.0), (17.0, 15.0)]),
            Dot((3.0, 15.0)),
            Dot((17.0, 15.0)),
            Ring((10.0, 15.0)),
        ],
        "Arc about centre" => &[
            Curve([(17.0, 8.0), (15.0, 3.0), (9.5, 1.5), (5.0, 4.0)]),
            Dashed(&[(9.0, 16.0), (17.0, 8.0)]),
            Dashed(&[(9.0, 16.0), (5.0, 4.0)]),
            Dot((9.0, 16.0)),
        ],
        "Tangent arc" => &[
            Line(&[(2.0, 16.5), (9.0, 16.5)]),
            Curve([(9.0, 16.5), (15.0, 16.5), (17.5, 11.0), (16.0, 4.0)]),
            Dot((9.0, 16.5)),
            Ring((16.0, 4.0)),
        ],
        "Circle" => &[
            Curve([(3.0, 10.0), (3.0, 0.7), (17.0, 0.7), (17.0, 10.0)]),
            Curve([(17.0, 10.0), (17.0, 19.3), (3.0, 19.3), (3.0, 10.0)]),
            Dot((10.0, 10.0)),
        ],
        "Polygon" => &[
            Line(&[
                (4.0, 16.0),
                (3.0, 7.0),
                (11.0, 3.0),
                (17.0, 9.0),
                (14.0, 16.5),
                (4.0, 16.0),
            ]),
            Dot((4.0, 16.0)),
        ],
        "Rectangle" => &[Line(&[
            (3.0, 4.5),
            (17.0, 4.5),
            (17.0, 15.5),
            (3.0, 15.5),
            (3.0, 4.5),
        ])],
        "Move" => &[
            Line(&[(10.0, 2.0), (10.0, 18.0)]),
            Line(&[(2.0, 10.0), (18.0, 10.0)]),
            Line(&[(7.8, 4.4), (10.0, 2.0), (12.2, 4.4)]),
            Line(&[(7.8, 15.6), (10.0, 18.0), (12.2, 15.6)]),
            Line(&[(4.4, 7.8), (2.0, 10.0), (4.4, 12.2)]),
            Line(&[(15.6, 7.8), (18.0, 10.0), (15.6, 12.2)]),
        ],
        "Turn" => &[
            Curve([(4.0, 13.5), (2.5, 3.0), (16.0, 0.5), (16.6, 10.0)]),
            Line(&[(13.6, 7.6), (16.7, 11.0), (18.8, 7.0)]),
            Dot((10.0, 15.5)),
        ],
        "Mirror" => &[
            Dashed(&[(10.0, 2.0), (10.0, 18.0)]),
            Filled(&[(7.5, 5.0), (7.5, 15.0), (2.0, 15.0)]),
            Line(&[(12.5, 5.0), (12.5, 15.0), (18.0, 15.0), (12.5, 5.0)]),
        ],
        "Scale" => &[
            Line(&[
                (3.0, 11.0),
                (9.0, 11.0),
                (9.0, 17.0),
                (3.0, 17.0),
                (3.0, 11.0),
            ]),
            Dashed(&[
                (3.0, 9.0),
                (3.0, 3.0),
                (17.0, 3.0),
                (17.0, 17.0),
                (11.0, 17.0),
            ]),
            Line(&[(9.5, 10.5), (14.0, 6.0)]),
            Line(&[(10.8, 5.8), (14.2, 5.8), (14.2, 9.2)]),
        ],
        "Measure" => &[
            Line(&[
                (2.0, 7.0),
                (18.0, 7.0),
                (18.0, 13.0),
                (2.0, 13.0),
                (2.0, 7.0),
            ]),
            Line(&[(5.2, 7.0), (5.2, 10.0)]),
            Line(&[(8.4, 7.0), (8.4, 9.0)]),
            Line(&[(11.6, 7.0), (11.6, 10.0)]),
            Line(&[(14.8, 7.0), (14.8, 9.0)]),
        ],
        "Point from" => &[
            Dot((3.5, 16.0)),
            Dashed(&[(3.5, 16.0), (15.5, 5.0)]),
            Line(&[(3.5, 16.0), (17.0, 16.0)]),
            Curve([(11.0, 16.0), (11.0, 14.0), (10.4, 12.2), (9.2, 10.8)]),
            Ring((15.5, 5.0)),
        ],
        "Point along" => &[
            Curve([(2.5, 15.0), (6.0, 2.0), (14.0, 2.0), (17.5, 15.0)]),
            Dot((2.5, 15.0)),
            Ring((13.5, 7.0)),
        ],
        "Perpendicular" => &[
            Line(&[(2.0, 16.0), (18.0, 16.0)]),
            Dashed(&[(10.0, 3.5), (10.0, 16.0)]),
            Line(&[(10.0, 12.5), (13.5, 12.5), (13.5, 16.0)]),
            Dot((10.0, 3.5)),
            Ring((10.0, 16.0)),
        ],
        "Mirror point" => &[
            Dashed(&[(10.0, 2.0), (10.0, 18.0)]),
            Line(&[(4.0, 10.0), (16.0, 10.0)]),
            Dot((4.0, 10.0)),
            Ring((16.0, 10.0)),
        ],
        "Compass on line" => &[
            Line(&[(2.0, 15.5), (18.0, 15.5)]),
            Dashed(&[(6.0, 4.0), (14.0, 15.5)]),
            Curve([(17.0, 11.5), (16.0, 14.0), (14.0, 16.5), (11.5, 18.0)]),
            Dot((6.0, 4.0)),
            Ring((14.0, 15.5)),
        ],
        "Two compasses" => &[
            Curve([(5.5, 3.5), (9.5, 3.5), (13.0, 6.0), (14.5, 9.5)]),
            Curve([(14.5, 3.5), (10.5, 3.5), (7.0, 6.0), (5.5, 9.5)]),
            Dot((4.0, 16.0)),
            Dot((16.0, 16.0)),
            Ring((10.0, 4.6)),
        ],
        "Trace" => &[
            Filled(&[(6.0, 6.0), (14.0, 6.0), (15.5, 15.0), (4.5, 15.0)]),
            Dashed(&[
                (4.0, 3.0),
                (16.0, 3.0),
                (18.5, 17.5),
                (1.5, 17.5),
                (4.0, 3.0),
            ]),
        ],
        "Divide edge" => &[
            Line(&[(2.0, 13.5), (7.9, 10.9)]),
            Line(&[(12.1, 9.1), (18.0, 6.5)]),
            Ring((10.0, 10.0)),
            Line(&[(8.0, 5.0), (9.0, 7.3)]),
            Line(&[(11.0, 12.7), (12.0, 15.0)]),
        ],
        "Bend edge" => &[
            Dashed(&[(2.5, 15.0), (17.5, 15.0)]),
            Curve([(2.5, 15.0), (5.0, 2.5), (15.0, 2.5), (17.5, 15.0)]),
            Dot((2.5, 15.0)),
            Dot((17.5, 15.0)),
        ],
        "Dart" => &[
            Line(&[
                (1.5, 4.0),
                (6.5, 4.0),
                (10.0, 16.5),
                (13.5, 4.0),
                (18.5, 4.0),
            ]),
            Dashed(&[(6.5, 4.0), (13.5, 4.0)]),
        ],
        "Fisheye dart" => &[Line(&[
            (10.0, 1.5),
            (13.4, 10.0),
            (10.0, 18.5),
            (6.6, 10.0),
            (10.0, 1.5),
        ])],
        "Pivot dart" => &[
            Line(&[(7.5, 2.5), (10.0, 12.5), (12.5, 2.5)]),
            Dashed(&[(18.0, 9.0), (10.0, 12.5), (18.0, 14.5)]),
            Curve([(14.5, 3.5), (16.0, 4.5), (16.6, 5.3), (16.9, 6.4)]),
            Line(&[(14.8, 5.4), (17.0, 7.0), (18.4, 4.6)]),
        ],
        "Spread" => &[
            Line(&[(10.0, 17.5), (3.5, 5.5)]),
            Line(&[(10.0, 17.5), (8.3, 3.6)]),
            Line(&[(10.0, 17.5), (11.7, 3.6)]),
            Line(&[(10.0, 17.5), (16.5, 5.5)]),
            Curve([(3.5, 5.5), (5.0, 4.6), (6.6, 3.9), (8.3, 3.6)]),
            Curve([(11.7, 3.6), (13.4, 3.9), (15.0, 4.6), (16.5, 5.5)]),
        ],
        "Split" => &[
            Line(&[(8.0, 4.0), (2.5, 4.0), (2.5, 16.0), (6.5, 16.0), (8.0, 4.0)]),
            Line(&[
                (12.0, 4.0),
                (17.5, 4.0),
                (17.5, 16.0),
                (10.5, 16.0),
                (12.0, 4.0),
            ]),
        ],
        "Fold" => &[
            Line(&[(10.0, 3.0), (17.0, 3.0), (17.0, 17.0), (10.0, 17.0)]),
            Dashed(&[(10.0, 1.5), (10.0, 18.5)]),
            Dashed(&[(10.0, 3.0), (3.0, 3.0), (3.0, 17.0), (10.0, 17.0)]),
        ],
        "Notch" => &[
            Line(&[
                (1.5, 12.0),
                (7.5, 12.0),
                (10.0, 5.5),
                (12.5, 12.0),
                (18.5, 12.0),
            ]),
            Dashed(&[(1.5, 16.0), (18.5, 16.0)]),
        ],
        "Inner line" => &[
            Line(&[
                (2.5, 3.5),
                (17.5, 3.5),
                (17.5, 16.5),
                (2.5, 16.5),
                (2.5, 3.5),
            ]),
            Curve([(5.0, 12.0), (8.0, 5.0), (12.0, 15.0), (15.0, 8.0)]),
        ],
        "Grain" => &[
            Line(&[(10.0, 2.0), (10.0, 18.0)]),
            Line(&[(7.6, 5.0), (10.0, 2.0), (12.4, 5.0)]),
            Line(&[(7.6, 15.0), (10.0, 18.0), (12.4, 15.0)]),
        ],
        "Seam" => &[
            Line(&[(5.5, 2.5), (5.5, 17.5)]),
            Line(&[(14.5, 2.5), (14.5, 17.5)]),
            Line(&[(5.5, 5.0), (14.5, 5.0)]),
            Line(&[(5.5, 10.0), (14.5, 10.0)]),
            Line(&[(5.5, 15.0), (14.5, 15.0)]),
        ],
        "Matched notches" => &[
            Line(&[
                (7.0, 2.0),
                (7.0, 7.5),
                (3.5, 10.0),
                (7.0, 12.5),
                (7.0, 18.0),
            ]),
            Line(&[
                (13.0, 2.0),
                (13.0, 7.5),
                (16.5, 10.0),
                (13.0, 12.5),
                (13.0, 18.0),
            ]),
        ],
        "Walk seam" => &[
            Curve([(2.5, 4.0), (6.0, 12.0), (14.0, 12.0), (17.5, 4.0)]),
            Line(&[(2.5, 11.5), (17.5, 11.5)]),
            Dot((10.0, 10.6)),
            Line(&[(5.0, 16.5), (15.0, 16.5)]),
            Line(&[(12.4, 14.2), (15.0, 16.5), (12.4, 18.8)]),
        ],
        _ => &[],
    }
}

/// Draws the icon of a command in the middle of a rectangle.
pub fn paint(painter: &Painter, rect: Rect, command: &str, colour: Color32) {
    let scale = rect.size().min_elem() / SIDE;
    let at = |(x, y): Place| rect.center() + egui::vec2(x - SIDE / 2.0, y - SIDE / 2.0) * scale;
    let all = |places: &[Place]| places.iter().map(|place| at(*place)).collect::<Vec<Pos2>>();
    let stroke = Stroke::new(WIDTH * scale, colour);
    for stroked in strokes(command) {
        match stroked {
            Line(places) => {
                painter.add(Shape::line(all(places), stroke));
            }
            Dashed(places) => {
                let [dash, gap] = DASH.map(|length| length * scale);
                painter.extend(Shape::dashed_line(&all(places), stroke, dash, gap));
            }
            // Drawn as if convex: the outline and the small size hide the errors of a polygon that is not
            // convex.
            Filled(places) => {
                painter.add(Shape::convex_polygon(
                    all(places),
                    colour.gamma_multiply(0.35),
                    stroke,
                ));
            }
            Curve(places) => {
                let places = places.map(at);
                painter.add(CubicBezierShape::from_points_stroke(
                    places,
                    false,
                    Color32::TRANSPARENT,
                    stroke,
                ));
            }
            Dot(place) => {
                painter.add(CircleShape::filled(at(*place), 2.0 * scale, colour));
            }
            Ring(place) => {
                let fill = painter.ctx().global_style().visuals.panel_fill;
                painter.add(CircleShape {
                    center: at(*place),
                    radius: 2.1 * scale,
                    fill,
                    stroke,
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tool_bar::tools;
    use super::*;

    #[test]
    fn every_tool_of_the_tool_bar_has_a_sign_that_lies_on_its_square() {
        let is_on = |(x, y): &Place| [x, y].iter().all(|v| (0.0..=SIDE).contains(*v));
        for tool in tools() {
            let strokes = strokes(tool);
            assert!(!strokes.is_empty(), "{tool} has no sign");
            for stroked in strokes {
                let inside = match stroked {
                    Line(places) | Dashed(places) | Filled(places) => places.iter().all(is_on),
                    // End points only: control points may lie outside.
                    Curve(places) => is_on(&places[0]) && is_on(&places[3]),
                    Dot(place) | Ring(place) => is_on(place),
                };
                assert!(inside, "{tool} reaches beyond its square");
            }
        }
    }
}

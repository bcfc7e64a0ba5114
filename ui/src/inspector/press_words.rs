//! Pressing directions in words.

use crate::canvas::press::{press_ways, toward_fold};
use crate::canvas::scene::PanelScene;
use toile_geometry::Vec2;
use toile_pattern::{Operation, OperationKind};

/// Words for the two directions in which a dart or pleat can be pressed, in the order of the choices: to the
/// centre, which lies on the fold line, or to the side. Without a fold, or along it: right, left, up or down
/// on the drawing, which shows the right side of the cloth. If no arrow is known: by the name of the choice.
pub fn press_words(panel: Option<&PanelScene>, step: &Operation) -> [&'static str; 2] {
    let found = panel.and_then(|panel| Some((panel, press_ways(&panel.pressed, step)?)));
    match found {
        Some((panel, (at, ways))) => ways.map(|way| words(way, at, panel.fold)),
        None => match step.kind {
            OperationKind::Pleat { .. } => ["left of its line", "right of its line"],
            _ => ["before its point", "after its point"],
        },
    }
}

fn words(way: Vec2, at: Vec2, fold: Option<[Vec2; 2]>) -> &'static str {
    match fold.and_then(|fold| toward_fold((at, way), fold)) {
        Some(toward) if toward > 0.5 => "to the centre",
        Some(toward) if toward < -0.5 => "to the side",
        _ if way.x.abs() >= way.y.abs() => match way.x > 0.0 {
            true => "to the right",
            false => "to the left",
        },
        _ => match way.y > 0.0 {
            true => "up",
            false => "down",
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_centre_lies_on_the_fold() {
        let fold = Some([Vec2::new(0.0, 0.0), Vec2::new(0.0, 0.6)]);
        let at = Vec2::new(0.1, 0.5);
        let told = |x: f64, y: f64, fold| words(Vec2::new(x, y), at, fold);
        assert_eq!(told(-1.0, 0.1, fold), "to the centre");
        assert_eq!(told(1.0, 0.1, fold), "to the side");
        assert_eq!(told(0.1, -1.0, fold), "down");
        assert_eq!(told(-1.0, 0.1, None), "to the left");
        assert_eq!(told(0.0, 1.0, None), "up");
    }
}

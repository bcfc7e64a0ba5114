//! The tag of a sheet: a small cross at its origin with its name, by which the sheet is selected and
//! moved. It is shown if there are several sheets and the choice of the current one can matter.

use super::scene::{Scene, SheetScene};
use egui::{Pos2, Rect, pos2, vec2};
use toile_geometry::Vec2;
use toile_pattern::SheetId;

/// Gap between a sheet's origin and its name (pixels).
const GAP: f32 = 7.0;
/// Height of the background of the name (pixels).
const HEIGHT: f32 = 18.0;
/// Width per letter of the background of the name (pixels): fixed, so that clicks can be tested without
/// laying out text.
const LETTER: f32 = 6.8;
/// Half the length of the lines of the cross (pixels).
pub(super) const CROSS: f32 = 8.0;

/// Sheets whose tags are shown, if several sheets are free (lie on no panel): those on which no panel is
/// traced, and the open ones.
pub fn tagged<'s>(
    scene: &'s Scene,
    open: &'s [SheetId],
) -> impl Iterator<Item = &'s SheetScene> + use<'s> {
    let free = scene.sheets.iter().filter(|sheet| sheet.on.is_none());
    let is_several = free.clone().count() > 1;
    free.filter(move |sheet| is_several && (sheet.is_bare || open.contains(&sheet.id)))
}

/// Background of a sheet's name, relative to its origin (pixels, Y down).
pub(super) fn ground(sheet: &SheetScene) -> Rect {
    let letters = sheet.name.chars().count() as f32;
    let size = vec2(letters.mul_add(LETTER, 10.0), HEIGHT);
    Rect::from_min_size(pos2(GAP, -GAP - HEIGHT), size)
}

/// Distance from a place of the table to the tag of a sheet with a given origin (m); `None` if the place
/// is not on the tag. `scale` is in pixels per metre.
pub fn distance(sheet: &SheetScene, origin: Vec2, at: Vec2, scale: f64) -> Option<f64> {
    let way = (at - origin) * scale;
    let seen = Pos2::new(way.x as f32, -way.y as f32);
    let on_cross = way.norm() <= f64::from(CROSS);
    let away = f64::from(ground(sheet).distance_to_pos(seen)).min(way.norm());
    (on_cross || ground(sheet).contains(seen)).then_some(away / scale)
}

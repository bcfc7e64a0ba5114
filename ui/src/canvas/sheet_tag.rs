//! The tag of a sheet: a small cross at its origin with its name, by which the sheet is selected and
//! moved. It is shown where there are several sheets and it can matter which one is drawn on.

use super::scene::{Scene, SheetScene};
use egui::{Pos2, Rect, pos2, vec2};
use toile_geometry::Vec2;
use toile_pattern::SheetId;

/// Room between a sheet's origin and its name (pixels).
const GAP: f32 = 7.0;
/// Height of the name's ground (pixels).
const HEIGHT: f32 = 18.0;
/// Width of a letter of the name's ground: the ground can be clicked on where no text is laid out
/// (pixels).
const LETTER: f32 = 6.8;
/// Half the length of the lines of the cross (pixels).
pub(super) const CROSS: f32 = 8.0;

/// The sheets whose tags are shown: of several free sheets those that nothing is traced from, and
/// those that are open.
pub fn tagged<'s>(
    scene: &'s Scene,
    open: &'s [SheetId],
) -> impl Iterator<Item = &'s SheetScene> + use<'s> {
    let free = scene.sheets.iter().filter(|sheet| sheet.on.is_none());
    let is_several = free.clone().count() > 1;
    free.filter(move |sheet| is_several && (sheet.is_bare || open.contains(&sheet.id)))
}

/// The ground of a sheet's name, seen from its origin [pixels, Y down].
pub(super) fn ground(sheet: &SheetScene) -> Rect {
    let letters = sheet.name.chars().count() as f32;
    let size = vec2(letters.mul_add(LETTER, 10.0), HEIGHT);
    Rect::from_min_size(pos2(GAP, -GAP - HEIGHT), size)
}

/// How far a place of the table is from the tag of a sheet whose origin is there (m); nothing where
/// it is not on it. The table is seen with so many pixels a metre.
pub fn distance(sheet: &SheetScene, origin: Vec2, at: Vec2, scale: f64) -> Option<f64> {
    let way = (at - origin) * scale;
    let seen = Pos2::new(way.x as f32, -way.y as f32);
    let on_cross = way.norm() <= f64::from(CROSS);
    let away = f64::from(ground(sheet).distance_to_pos(seen)).min(way.norm());
    (on_cross || ground(sheet).contains(seen)).then_some(away / scale)
}

//! Clothes on a moving figure in real time: the figure's ellipsoids and skin, and garments whose
//! drape is their rest shape.

use crate::drape::Drape;
use crate::{Command, OtherGarment, Quality, Session, SessionError, Watcher};
use std::path::PathBuf;
use strum::{EnumCount, VariantArray, VariantNames};
use toile_body::{Clip, Figure, Mannequin, Skeleton};
use toile_geometry::{TriangleMesh, Vec3};
use toile_picture::{
    Backdrop, Camera, Edges, Finish, Image, Lines, Paint, Projection, Scene, Surface, View, render,
};
use toile_realtime::{Character, Ellipsoids, Garment, GarmentSettings, RealtimeError};

/// Method that adjusts clothes in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Adjustment {
    /// Clothes hang by gravity.
    #[default]
    Gravity,
    /// Clothes keep their shape and fit closely.
    Shape,
}

/// Commands for a figure in real time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumCount, VariantArray, VariantNames)]
pub enum RealtimeKey {
    /// Stand.
    #[strum(serialize = "down")]
    Stand,
    /// Walk.
    #[strum(serialize = "up")]
    Walk,
    /// Run.
    #[strum(serialize = "right")]
    Run,
    /// Switch between the two kinds of [`Adjustment`].
    #[strum(serialize = "g")]
    Switch,
}

impl RealtimeKey {
    /// All commands, each with the name of its key.
    pub const ALL: [(&'static str, Self); Self::COUNT] = toile_geometry::named_variants!();

    /// Finds a command by the name of its key.
    pub fn named(name: &str) -> Option<Self> {
        let found = Self::ALL.iter().find(|(known, _)| *known == name);
        found.map(|(_, key)| *key)
    }
}

/// A surface of triangles in `f32`, with a colour for each triangle (sRGB, 0..=1).
#[derive(Clone, Debug, Default)]
pub struct RealtimeSurface {
    /// Name of the surface.
    pub name: String,
    /// Positions of the vertices (m).
    pub positions: Vec<[f32; 3]>,
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Colours of the triangles.
    pub colours: Vec<[f64; 3]>,
}

/// A skin whose vertices are blended from the motions of several joints.
struct Skin {
    /// Positions of the vertices at rest (m).
    rest: Vec<[f32; 3]>,
    /// For each vertex, the joints that move it, with the share of each (1).
    shares: Vec<Vec<(u16, f32)>>,
    /// Present motions of the joints.
    motions: Vec<toile_realtime::Frame>,
}

/// A dressed figure in real time.
pub struct RealtimeRun {
    ellipsoids: Ellipsoids,
    skin: Skin,
    /// Surface of the body, as it is shown.
    pub body: RealtimeSurface,
    /// Surfaces of the garments, as they are shown, the innermost first.
    pub clothes: Vec<RealtimeSurface>,
    garments: Vec<Garment>,
    adjustment: Adjustment,
}

/// Fade from one clip to the next (s): about a step.
const FADE: f32 = 0.4;

/// Distance of the innermost garment from the ellipsoids (m): most of the skin lies within the ellipsoids,
/// but not all of it.
const FIRST_OFFSET: f32 = 0.006;
/// Distance of each further garment from the garment below it (m).
const NEXT_OFFSET: f32 = 0.008;

/// Colour of the body (sRGB).
const SKIN: [f64; 3] = [0.80, 0.77, 0.74];

fn single(p: Vec3) -> [f32; 3] {
    [p.x as f32, p.y as f32, p.z as f32]
}

fn cannot(error: RealtimeError) -> SessionError {
    SessionError::Conflict(error.to_string())
}

/// The program's own clips that a character of the window has, by name.
pub(crate) fn own_clips(skeleton: &Skeleton) -> [(&'static str, Clip); 4] {
    [
        ("stand", Clip::stand(skeleton)),
        ("astride", Clip::astride(skeleton)),
        ("walk", Clip::walk(skeleton)),
        ("run", Clip::run(skeleton)),
    ]
}

/// The average woman as a character that stands, walks and runs.
///
/// # Errors
/// None that is known: the average woman can be made.
pub fn woman_character() -> Result<Character, SessionError> {
    let body = Mannequin::new(&Figure::Woman.average(), Figure::Woman)?;
    character_with(&body, None)
}

/// A body as a character with the program's own clips and one more clip, `more`, which replaces an own clip
/// of the same name.
pub(crate) fn character_with(
    body: &Mannequin,
    more: Option<(&str, &Clip)>,
) -> Result<Character, SessionError> {
    let own = own_clips(body.skeleton());
    let own = own.iter().map(|(name, clip)| (*name, clip));
    let others = own.filter(|(name, _)| more.is_none_or(|(new, _)| new != *name));
    let clips: Vec<(&str, &Clip)> = others.chain(more).collect();
    Ok(body.character(&clips)?)
}

impl RealtimeRun {
    /// Dresses a figure: the patterns are sewn on it and draped at the quality of a preview, each in
    /// a layer of its own, the first innermost.
    ///
    /// # Errors
    /// A pattern that cannot be read or made, clothes no ellipsoids fit into; the watcher asked to
    /// stop.
    pub fn dressed(
        figure: Figure,
        patterns: &[PathBuf],
        watcher: &mut dyn Watcher,
    ) -> Result<Self, SessionError> {
        let Some((path, others)) = patterns.split_first() else {
            return Err(SessionError::Conflict(
                "no pattern to dress the figure in; name one, as in --figure woman skirt.toile.json"
                    .to_owned(),
            ));
        };
        let mut commands = vec![Command::open(path.clone())];
        if !others.is_empty() {
            let others = others.iter().zip(2..);
            let others = others.map(|(path, layer)| OtherGarment {
                path: path.clone(),
                layer,
            });
            commands.push(Command::SetLayers {
                layer: 1,
                others: others.collect(),
            });
        }
        commands.extend([
            Command::SetBody {
                figure: Some(figure),
                measurements: None,
            },
            Command::SetQuality {
                quality: Quality::Preview,
            },
            Command::drape(),
        ]);
        let mut session = Session::new();
        session.execute_all(&commands, watcher)?;
        let body = session.mannequin()?;
        let drape = session.derived.drape.clone();
        let drape = drape.ok_or_else(|| SessionError::Conflict("nothing was draped".to_owned()))?;
        Self::new(&body, clothes(&drape))
    }

    /// Dresses a body in clothes that lie on it at rest.
    ///
    /// # Errors
    /// A body whose ellipsoids are not rigid, clothes no ellipsoids fit into.
    pub(crate) fn new(
        body: &Mannequin,
        clothes: Vec<RealtimeSurface>,
    ) -> Result<Self, SessionError> {
        let mut ellipsoids = Ellipsoids::new(&character_with(body, None)?).map_err(cannot)?;
        let mut garments = Vec::new();
        for (k, cloth) in clothes.iter().enumerate() {
            let settings = GarmentSettings {
                offset: FIRST_OFFSET + k as f32 * NEXT_OFFSET,
                ..GarmentSettings::default()
            };
            let made = Garment::new(&ellipsoids, &cloth.positions, &cloth.triangles, settings);
            garments.push(made.map_err(cannot)?);
        }
        let skin = body.skin();
        let positions: Vec<[f32; 3]> = skin.positions.iter().map(|&p| single(p)).collect();
        let shares = (0..positions.len()).map(|v| {
            let own = body.shares(v).iter();
            own.map(|&(joint, share)| (joint as u16, share as f32))
                .collect()
        });
        ellipsoids.start("stand", 2.0 * FADE).map_err(cannot)?;
        Ok(Self {
            skin: Skin {
                shares: shares.collect(),
                rest: positions.clone(),
                motions: Vec::new(),
            },
            body: RealtimeSurface {
                name: "body".to_owned(),
                colours: vec![SKIN; skin.triangles.len()],
                triangles: skin.triangles.clone(),
                positions,
            },
            ellipsoids,
            clothes,
            garments,
            adjustment: Adjustment::default(),
        })
    }

    /// The adjustment of this frame.
    pub fn adjustment(&self) -> Adjustment {
        self.adjustment
    }

    /// The clip that is played.
    pub fn clip(&self) -> &str {
        self.ellipsoids.playing().unwrap_or_default()
    }

    /// The garments, the innermost first.
    pub fn garments(&self) -> &[Garment] {
        &self.garments
    }

    /// Executes a command, as if its key were pressed.
    ///
    /// # Errors
    /// The character has no such clip.
    pub fn press(&mut self, key: RealtimeKey) -> Result<(), SessionError> {
        let clip = match key {
            RealtimeKey::Stand => "stand",
            RealtimeKey::Walk => "walk",
            RealtimeKey::Run => "run",
            RealtimeKey::Switch => {
                self.adjustment = match self.adjustment {
                    Adjustment::Gravity => Adjustment::Shape,
                    Adjustment::Shape => Adjustment::Gravity,
                };
                return Ok(());
            }
        };
        self.ellipsoids.start(clip, FADE).map_err(cannot)
    }

    /// Computes one frame, `dt` (s) after the last frame: first the ellipsoids, then every garment. The shown
    /// surfaces change only with [`RealtimeRun::show`].
    pub fn frame(&mut self, dt: f32) {
        self.ellipsoids.advance(dt);
        for garment in &mut self.garments {
            match self.adjustment {
                Adjustment::Gravity => garment.adjust_by_gravity(&self.ellipsoids, dt),
                Adjustment::Shape => garment.adjust_by_shape(&self.ellipsoids, dt),
            }
        }
    }

    /// Updates the shown surfaces to the last frame.
    pub fn show(&mut self) {
        let skin = &mut self.skin;
        skin.motions.clear();
        skin.motions.extend(self.ellipsoids.motions());
        let posed = self.body.positions.iter_mut().zip(&skin.rest);
        for ((place, rest), shares) in posed.zip(&skin.shares) {
            *place = [0.0; 3];
            for &(joint, share) in shares {
                let moved = skin.motions[usize::from(joint)].applied(*rest);
                *place = std::array::from_fn(|k| place[k] + share * moved[k]);
            }
        }
        for (cloth, garment) in self.clothes.iter_mut().zip(&self.garments) {
            for (into, place) in cloth.positions.iter_mut().zip(garment.positions()) {
                *into = place;
            }
        }
    }

    /// Presses keys, each followed by a number of frames of a sixtieth of a second, and paints the
    /// figure after each: pictures of a size (pixels), side by side, as PNG.
    ///
    /// # Errors
    /// No keys, or more pictures than fit into one.
    pub fn pictures(
        &mut self,
        keys: &[(RealtimeKey, usize)],
        [width, height]: [usize; 2],
    ) -> Result<Vec<u8>, SessionError> {
        let bounds = self.scene().bounds().unwrap_or_default();
        let aspect = width as f64 / height as f64;
        let camera = Camera::fit_to(bounds, View::ThreeQuarter, aspect, Projection::Perspective);
        let mut strip = Image::new(width * keys.len(), height, [1.0; 3])?;
        for (k, (key, frames)) in keys.iter().enumerate() {
            self.press(*key)?;
            for _ in 0..*frames {
                self.frame(1.0 / 60.0);
            }
            self.show();
            let picture = render(
                &self.scene(),
                &camera,
                [width, height],
                &Backdrop::default(),
            )?;
            strip.place(&picture, k * width, 0);
        }
        Ok(strip.to_png()?)
    }

    fn scene(&self) -> Scene {
        let clothes = self
            .clothes
            .iter()
            .map(|cloth| surface(cloth, Finish::Cloth));
        let body = surface(&self.body, Finish::Smooth);
        Scene {
            surfaces: clothes.chain([body]).collect(),
        }
    }
}

fn surface(shown: &RealtimeSurface, finish: Finish) -> Surface {
    let place = |p: &[f32; 3]| Vec3::from(p.map(f64::from));
    Surface {
        mesh: TriangleMesh {
            positions: shown.positions.iter().map(place).collect(),
            triangles: shown.triangles.clone(),
        },
        normals: Vec::new(),
        paint: Paint::PerTriangle(shown.colours.clone()),
        finish,
        lines: Lines {
            edges: Edges::Pairs(Vec::new()),
            colour: [0.2; 3],
            width: 1.0,
            opacity: 0.5,
        },
        framed: true,
    }
}

/// The garments of a drape, each with the vertices of its own triangles.
fn clothes(drape: &Drape) -> Vec<RealtimeSurface> {
    let mut colours = vec![[0.7; 3]; drape.job.garment.triangles.len()];
    for (panel, look) in drape.job.garment.panels.iter().zip(drape.job.panels.iter()) {
        colours[panel.triangles.clone()].fill(look.colour);
    }
    let mut parts: Vec<_> = drape.job.parts.iter().collect();
    parts.sort_by_key(|part| part.layer);
    let mut made = Vec::new();
    for part in parts {
        let mut cloth = RealtimeSurface {
            name: part.name.clone(),
            ..RealtimeSurface::default()
        };
        let mut number = vec![u32::MAX; drape.mesh.positions.len()];
        for (triangle, &origin) in drape.mesh.triangles.iter().zip(&drape.origin) {
            if !part.triangles.contains(&(origin as usize)) {
                continue;
            }
            cloth.triangles.push(triangle.map(|v| {
                let known = &mut number[v as usize];
                if *known == u32::MAX {
                    *known = cloth.positions.len() as u32;
                    cloth
                        .positions
                        .push(single(drape.mesh.positions[v as usize]));
                }
                *known
            }));
            cloth.colours.push(colours[origin as usize]);
        }
        made.push(cloth);
    }
    made
}

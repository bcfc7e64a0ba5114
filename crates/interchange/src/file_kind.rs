//! Kinds of files that are told by their content.

/// A kind of file that can be told from its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// Only white space.
    Empty,
    /// Text in UTF-16.
    Utf16,
    /// PNG, JPEG, GIF, BMP, TIFF or WebP.
    Picture,
    /// PDF.
    Pdf,
    /// PostScript or EPS.
    PostScript,
    /// A compressed archive, ZIP or gzip.
    Archive,
    /// glTF 2.0 binary.
    Glb,
    /// DXF, text or binary.
    Dxf,
    /// DWG, the format of AutoCAD's drawings.
    Dwg,
    /// A drawing in SVG.
    Svg,
    /// A marker of this program drawn in SVG.
    DrawnMarker,
    /// A print of pieces by this program in SVG.
    Print,
    /// A page of HTML.
    Html,
    /// HPGL, the language of plotters.
    Hpgl,
    /// A pattern of Valentina (.val).
    ValentinaPattern,
    /// A pattern of Seamly2D (.sm2d).
    SeamlyPattern,
    /// A pattern drafted by FreeSewing.
    FreeSewingPattern,
    /// XML of some other kind.
    OtherXml,
    /// STL.
    Stl,
    /// A table of measurements in any supported form.
    Measurements,
    /// A Wavefront mesh.
    Obj,
    /// A PLY mesh.
    Ply,
    /// A BVH motion.
    Bvh,
    /// A VRML 97 or X3D file.
    X3d,
    /// A pattern of Toile.
    Pattern,
    /// A GarmentCode specification.
    GarmentCode,
    /// A mannequin.
    Mannequin,
    /// A marker (`marker.json`).
    Marker,
    /// Settings for marker making.
    MarkerSettings,
    /// A nesting instance of jagua-rs.
    NestingInstance,
    /// A grade rule table of a DXF.
    RuleTable,
    /// A scene.
    Scene,
    /// A report of a run.
    Report,
    /// A journal of commands.
    Journal,
    /// A fabric: test values, or values of a material.
    Fabric,
}

impl FileKind {
    /// Name of the kind in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Self::Empty => "an empty file",
            Self::Utf16 => "text in UTF-16",
            Self::Picture => "a picture",
            Self::Pdf => "a PDF",
            Self::PostScript => "PostScript",
            Self::Archive => "a compressed archive",
            Self::Glb => "a glTF binary",
            Self::Dxf => "a DXF drawing",
            Self::Dwg => "a DWG drawing",
            Self::Svg => "an SVG drawing",
            Self::DrawnMarker => "a marker that `toile nest` drew",
            Self::Print => "a print of pieces that `toile print` drew",
            Self::Html => "a web page",
            Self::Hpgl => "a plotter file (HPGL)",
            Self::ValentinaPattern => "a pattern of Valentina (.val)",
            Self::SeamlyPattern => "a pattern of Seamly2D (.sm2d)",
            Self::FreeSewingPattern => "a pattern drafted by FreeSewing",
            Self::OtherXml => "XML of a kind that is not known here",
            Self::Stl => "an STL mesh",
            Self::Measurements => "a table of measurements",
            Self::Obj => "an OBJ mesh",
            Self::Ply => "a PLY mesh",
            Self::Bvh => "a BVH motion",
            Self::X3d => "a VRML or X3D file",
            Self::Pattern => "a Toile pattern",
            Self::GarmentCode => "a GarmentCode pattern",
            Self::Mannequin => "a mannequin file",
            Self::Marker => "a marker",
            Self::MarkerSettings => "a file of marker settings",
            Self::NestingInstance => "a nesting instance",
            Self::RuleTable => "a grade rule table (RUL)",
            Self::Scene => "a scene",
            Self::Report => "a report",
            Self::Journal => "a journal",
            Self::Fabric => "a fabric file",
        }
    }
}

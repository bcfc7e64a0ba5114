//! Circles that are still to be opened. Entries are only ever taken out or made shorter.

/// Files of a crate, sorted, that still import each other in a circle.
pub type Known = (&'static str, &'static [&'static [&'static str]]);

/// By the folder of the crate's sources.
pub const KNOWN: &[Known] = &[
    ("crates/assembly/src", &[&["refinement.rs", "smoothing.rs"]]),
    (
        "crates/interchange/src",
        &[
            &["native/migrate/read.rs", "native/migrate/read_panel.rs"],
            &[
                "native/read.rs",
                "native/read_marker.rs",
                "native/read_operation.rs",
                "native/read_panel.rs",
                "native/read_seam.rs",
            ],
            &[
                "native/write.rs",
                "native/write_marker.rs",
                "native/write_operation.rs",
                "native/write_panel.rs",
                "native/write_seam.rs",
            ],
            &["x3d_nodes.rs", "x3d_vrml.rs", "x3d_xml.rs"],
        ],
    ),
    (
        "crates/lab/src",
        &[&["chart.rs", "chart_contact.rs", "chart_report.rs"]],
    ),
    ("crates/measure/src", &[&["catalogue.rs", "further.rs"]]),
    (
        "crates/nesting/src",
        &[
            &[
                "check.rs",
                "job.rs",
                "raster.rs",
                "shape.rs",
                "tables.rs",
                "turns.rs",
            ],
            &["referee.rs", "rules.rs"],
        ],
    ),
    (
        "crates/pattern/src",
        &[
            &["document/panel.rs", "draft.rs", "stage/mod.rs"],
            &["formula/mod.rs", "name.rs", "number.rs"],
        ],
    ),
    ("crates/picture/src", &[&["image.rs", "ink.rs"]]),
];

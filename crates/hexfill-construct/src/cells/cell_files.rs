//! The cell files, by name. A list, because a build script is not worth it.
//!
//! Source: ours (book, page `construction`, "Hexes: the cells").

/// One for every class of patterns.
pub(super) const CELL_FILES: &[(&str, &str)] = &[
    ("bb-lddd.cell", include_str!("../../data/cells/bb-lddd.cell")),
    ("bb-lddo.cell", include_str!("../../data/cells/bb-lddo.cell")),
    ("bb-ldod.cell", include_str!("../../data/cells/bb-ldod.cell")),
    ("bb-ldoo.cell", include_str!("../../data/cells/bb-ldoo.cell")),
    ("bb-llld.cell", include_str!("../../data/cells/bb-llld.cell")),
    ("bb-lllo.cell", include_str!("../../data/cells/bb-lllo.cell")),
    ("bb-lodd.cell", include_str!("../../data/cells/bb-lodd.cell")),
    ("bb-lodo.cell", include_str!("../../data/cells/bb-lodo.cell")),
    ("bb-lood.cell", include_str!("../../data/cells/bb-lood.cell")),
    ("bb-looo.cell", include_str!("../../data/cells/bb-looo.cell")),
    ("bw-ddlh.cell", include_str!("../../data/cells/bw-ddlh.cell")),
    ("bw-dohl.cell", include_str!("../../data/cells/bw-dohl.cell")),
    ("bw-dolh.cell", include_str!("../../data/cells/bw-dolh.cell")),
    ("bw-ldhh.cell", include_str!("../../data/cells/bw-ldhh.cell")),
    ("bw-ldll.cell", include_str!("../../data/cells/bw-ldll.cell")),
    ("bw-lllh.cell", include_str!("../../data/cells/bw-lllh.cell")),
    ("bw-lohh.cell", include_str!("../../data/cells/bw-lohh.cell")),
    ("bw-loll.cell", include_str!("../../data/cells/bw-loll.cell")),
    ("bw-oolh.cell", include_str!("../../data/cells/bw-oolh.cell")),
    ("ww-lhhh.cell", include_str!("../../data/cells/ww-lhhh.cell")),
    ("ww-lllh.cell", include_str!("../../data/cells/ww-lllh.cell")),
];

/// The same patterns by cells that embed in the cube: more hexes, positions in their files.
pub(super) const EMBEDDED_CELL_FILES: &[(&str, &str)] = &[
    ("bb-lddo.cell", include_str!("../../data/cells/embedded/bb-lddo.cell")),
    ("bb-ldoo.cell", include_str!("../../data/cells/embedded/bb-ldoo.cell")),
    ("bw-ddlh.cell", include_str!("../../data/cells/embedded/bw-ddlh.cell")),
    ("bw-dohl.cell", include_str!("../../data/cells/embedded/bw-dohl.cell")),
    ("bw-dolh.cell", include_str!("../../data/cells/embedded/bw-dolh.cell")),
    ("bw-ldhh.cell", include_str!("../../data/cells/embedded/bw-ldhh.cell")),
    ("bw-lohh.cell", include_str!("../../data/cells/embedded/bw-lohh.cell")),
    ("bw-oolh.cell", include_str!("../../data/cells/embedded/bw-oolh.cell")),
    ("ww-lhhh.cell", include_str!("../../data/cells/embedded/ww-lhhh.cell")),
    ("ww-lllh.cell", include_str!("../../data/cells/embedded/ww-lllh.cell")),
];

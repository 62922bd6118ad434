// The cell files, by name. A list, because a build script is not worth it.
const CELL_FILES: &[(&str, &str)] = &[
    ("bb-lddo.cell", include_str!("../data/cells/bb-lddo.cell")),
    ("bb-ldoo.cell", include_str!("../data/cells/bb-ldoo.cell")),
    ("bb-lodo.cell", include_str!("../data/cells/bb-lodo.cell")),
    ("bw-ddlh.cell", include_str!("../data/cells/bw-ddlh.cell")),
    ("bw-dohl.cell", include_str!("../data/cells/bw-dohl.cell")),
    ("bw-dolh.cell", include_str!("../data/cells/bw-dolh.cell")),
    ("bw-ldhh.cell", include_str!("../data/cells/bw-ldhh.cell")),
    ("bw-lllh.cell", include_str!("../data/cells/bw-lllh.cell")),
    ("bw-loll.cell", include_str!("../data/cells/bw-loll.cell")),
    ("bw-oolh.cell", include_str!("../data/cells/bw-oolh.cell")),
    ("ww-lhhh.cell", include_str!("../data/cells/ww-lhhh.cell")),
    ("ww-lllh.cell", include_str!("../data/cells/ww-lllh.cell")),
];

// The same patterns by cells that embed in the cube: more hexes, positions in their files.
const EMBEDDED_CELL_FILES: &[(&str, &str)] = &[
    ("ww-lhhh.cell", include_str!("../data/cells/embedded/ww-lhhh.cell")),
    ("ww-lllh.cell", include_str!("../data/cells/embedded/ww-lllh.cell")),
];

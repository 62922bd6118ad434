//! The compiled half of the Python package `hexfill`: the facade's verbs over plain arrays.
//!
//! The Python half (`python/hexfill/`) takes what people have (numpy arrays, PyVista, meshio, paths), checks it and says what is wrong
//! with it in their words; here it arrives as buffers of the right type. Three rules: long work runs on a thread of its own while
//! Python's lock is released (`work.rs`); every error is a typed exception with the ids it is about (`failure.rs`); no panic crosses
//! into Python as one.

mod choices;
mod data;
mod enumerating;
mod failure;
mod filling;
mod judging;
mod knowing;
mod words;
mod work;

#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use crate::data::{Data, load, prepared, write};
    #[pymodule_export]
    use crate::enumerating::enumerate;
    #[pymodule_export]
    use crate::filling::{embed, engines, fill, regions, simplify};
    #[pymodule_export]
    use crate::judging::check;
    #[pymodule_export]
    use crate::knowing::{atlas, catalog, catalog_mesh, doctor, html, info, mend, png};
    #[cfg(debug_assertions)]
    #[pymodule_export]
    use crate::work::panic_for_test;
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}

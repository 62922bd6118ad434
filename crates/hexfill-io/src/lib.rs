//! Reading and writing surface and mesh files

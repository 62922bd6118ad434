//! The independent judge of hex meshes and their boundaries

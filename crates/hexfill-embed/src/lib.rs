//! Coordinates for hex meshes: start, untangle, optimise

//! Cavities, flips and the atlas of smallest known fillings

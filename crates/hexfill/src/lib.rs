//! Fill a closed quad surface with hexahedra, leaving the surface exactly as it is

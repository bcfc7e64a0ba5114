//! Mannequins: skeleton, ellipsoid primitives, skin.

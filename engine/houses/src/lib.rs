//! Where houses come from: one folder a format, the built-in house, textures, `open`.

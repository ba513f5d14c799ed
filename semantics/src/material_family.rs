//! Families of substances: what people call metal or wood.

/// The adjective of a family, with the adjectives of the substances in it (`assets/materials.toml`).
const FAMILIES: [(&str, &[&str]); 2] = [
    (
        "metal",
        &[
            "steel",
            "chrome",
            "cast-iron",
            "brass",
            "copper",
            "aluminium",
            "enamelled",
        ],
    ),
    ("wooden", &["oak", "pine", "plywood", "chipboard"]),
];

/// The adjective of the family that a substance belongs to by its adjective, if any: oak is wooden.
pub(crate) fn family_of(adjective: &str) -> Option<&'static str> {
    let mut families = FAMILIES.iter();
    let own = families.find(|(_, members)| members.contains(&adjective));
    own.map(|(family, _)| *family)
}

/// The adjectives of families.
pub(crate) fn families() -> impl Iterator<Item = &'static str> {
    FAMILIES.iter().map(|(family, _)| *family)
}

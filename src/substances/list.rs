//! The substances of the library, by name.

use super::Substance;

/// Lists the files of a folder.
macro_rules! substances {
    ($folder:literal: $($name:literal,)*) => {
        &[$(Substance {
            name: $name,
            text: include_str!(concat!($folder, "/", $name, ".toml")),
        },)*]
    };
}

/// Materials of solids.
pub const SOLIDS: &[Substance] = substances![
    "solids":
    "abs",
    "alumina-99",
    "aluminium-6061",
    "aluminium-nitride",
    "aluminium",
    "borosilicate-glass",
    "brass",
    "bronze-aluminium",
    "bronze-phosphor",
    "cast-iron-grey",
    "concrete",
    "copper",
    "epoxy",
    "fr4",
    "fused-silica",
    "gold",
    "graphite-isotropic",
    "ice",
    "inconel-718",
    "lead",
    "molybdenum",
    "nickel",
    "pdms",
    "peek",
    "pla",
    "platinum",
    "pmma",
    "polycarbonate",
    "polyimide-kapton",
    "ptfe",
    "sac305",
    "sapphire",
    "silica-aerogel",
    "silicon-carbide",
    "silicon",
    "silver",
    "soda-lime-glass",
    "steel-304",
    "steel-316l",
    "steel-carbon",
    "steel-structural",
    "steel-tool-h13",
    "tin",
    "titanium-6al-4v",
    "titanium",
    "tungsten",
    "zinc",
    "zirconia-3ysz",
];

/// Fluids of droplets.
pub const FLUIDS: &[Substance] = substances![
    "fluids":
    "acetone",
    "ethanol",
    "ethylene-glycol",
    "fc-72",
    "gallium",
    "glycerol",
    "isopropanol",
    "kerosene",
    "mercury",
    "methanol",
    "molten-alumina",
    "molten-aluminium",
    "molten-bismuth",
    "molten-copper",
    "molten-gold",
    "molten-iron",
    "molten-lead",
    "molten-sac305",
    "molten-silver",
    "molten-sodium",
    "molten-tin",
    "molten-zinc",
    "n-dodecane",
    "n-eicosane",
    "n-heptane",
    "n-hexadecane",
    "nitrogen",
    "silicone-oil-100cst",
    "silicone-oil-10cst",
    "water",
];

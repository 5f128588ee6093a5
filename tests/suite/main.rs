//! What the library and its program do, one subject per file: in one program, so that the tests of all files share the
//! machine's cores. Tests that measure the process they run in have programs of their own beside this folder.

#[path = "../common/capillary.rs"]
mod capillary;
#[path = "../common/classical_flows.rs"]
mod classical_flows;
#[path = "../common/mod.rs"]
mod common;
#[path = "../common/falling_drop.rs"]
mod falling_drop;
#[path = "../common/forecast_cases.rs"]
mod forecast_cases;
#[path = "../common/resting_layer.rs"]
mod resting_layer;
#[path = "../common/thick_flows.rs"]
#[allow(dead_code)]
mod thick_flows;

mod adversarial;
mod architecture;
mod back_stress;
mod baths;
mod bends;
mod coarse_large_strain;
mod concrete;
mod contact;
mod cracks;
mod cracks_in_space;
mod creep;
mod demand;
mod derivatives;
mod driven_solids;
mod droplet;
mod exchanges;
mod failure;
mod field_means;
mod filament;
mod filament_particles;
mod lattice;
mod fine_meshes;
mod flaws;
mod flows;
mod footprints;
mod forecast;
mod freezing;
mod frozen;
mod held_faces;
mod impact;
mod implicit_steps;
mod impossible;
mod joints;
mod large_strain;
mod layered_mechanics;
mod layers;
mod levels;
mod long_steps;
mod many_probes;
mod missed_flow;
mod nonlinear_heat;
mod nonlinear_solids;
mod oblique;
mod output;
mod overlap;
mod particles;
mod parts;
mod peaks;
mod plastic_steps;
mod plausibility;
mod phases;
mod power;
mod pressure;
mod quadratic_elements;
mod recovered_stress;
mod reduced;
mod relaxation;
mod replay;
mod replay_walls;
mod reproducing;
mod reservoirs;
mod rings;
mod rows;
mod scene_reference;
mod scene_refusals;
mod shorthand;
mod solid;
mod solid_walls;
mod strand_shapes;
mod substance_reference;
mod tension;
mod small_trials;
mod thermal_stretch;
mod tolerance;
mod viscosity;
mod viscous;
mod walls;
mod warm_solids;
mod warning_reference;
mod yield_estimates;
mod yield_readings;
mod yielding;

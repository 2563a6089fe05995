//! `floe` turns folders of simulated fluid interfaces into image sequences.
//!
//! A deformable-simplicial-complex simulation carries water, ice and air as one tetrahedral mesh. The faces
//! between tetrahedra of different labels form a triangle mesh in which every triangle knows what lies on either
//! side. `floe` reads these interfaces as they are and renders transparent and turbid fluids on the CPU.
//!
//! # The way of the data
//! ```text
//! frames on disk -> sequence -> mesh -> accel -> optics + light -> scene -> integrator -> film -> images + ledger
//!                  (which,     (read,   (build,  (media, phase,   (one     (radiance    (accumulate,
//!                   order)      label,   refit,   Fresnel, sun,    frame,    along a      error, EXR,
//!                               check)   trace)   sky)             needs)    path)        PNG)
//!                            driver owns the loop: frames, threads, tiles, ledger
//!                            movie shows what was rendered; study measures: pictures, errors, media
//! ```
//! Each stage uses itself and the stages before it, never one after. [`geometry`], [`sampling`] and [`spectrum`]
//! are foundations under all.
//!
//! # Conventions
//! * Metres, nanometres, 1/m for coefficients, W m^-2 sr^-1 (nm^-1) for radiance. Degrees only in files and on
//!   the command line.
//! * `wo` and `wi` point away from the point. A phase function takes the [`optics::phase::Deflection`] between the
//!   directions of *travel*; g > 0 scatters forward.
//! * `eta_t_over_i` carries its order in its name. Densities carry their measure: `pdf_w` (solid angle), `pdf_a`
//!   (area), `pdf_d` (distance).
//! * A triangle's normal follows the right-hand rule and points into its `front` region.
//! * L / n^2 is invariant along a ray: when an eye path goes from medium a into medium b, its throughput is
//!   multiplied by (n_a / n_b)^2.
//! * A complex index is n + i k; k >= 0 absorbs.
//! * Row 0 of an image is the top.
//! * A sun's irradiance is on a plane perpendicular to its direction.
//! * A sample depends on (seed, frame, pixel, sample index, dimension) and on nothing else. Ties between hits are
//!   broken by triangle index. Elementary functions come from [`geometry::elementary`].

#![doc = include_str!("references.md")]

/// The vectors that meshes are made of.
pub use glam;

pub mod geometry;
pub mod sampling;
pub mod spectrum;

pub mod sequence;

pub mod mesh;

pub mod accel;

pub mod optics;

pub mod light;

pub mod scene;

pub mod integrator;

pub mod film;

pub mod driver;

pub mod movie;

pub mod study;

#[cfg(feature = "capi")]
pub mod capi;

#[cfg(feature = "cli")]
pub mod cli;

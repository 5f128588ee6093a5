//! Output files for people and viewers, made from Model and State only.

mod collection;
mod csv;
mod error;
mod forecast;
mod lock;
mod replace;
mod series;
mod vtk;

pub use csv::CsvTable;
pub use error::OutputError;
pub use forecast::FilesForecast;
pub use lock::FolderLock;
pub use replace::replace;
pub use series::{Discs, FieldSeries};

//! Memo of a droplet: readings of its state, computed when first needed.

use std::any::Any;

use crate::body::Memo;
use crate::method::sph::DropletTotals;
use crate::port::WallExchange;

/// Lazily computed readings of a droplet's state.
#[derive(Debug, Default)]
pub struct DropletMemo {
    pub totals: Option<DropletTotals>,
    pub exchange: Option<WallExchange>,
    pub frozen_on_wall: Option<Vec<f64>>,
}

impl DropletMemo {
    pub fn of_mut(memo: &mut Memo) -> &mut Self {
        let memo: &mut (dyn Any + Send + Sync) = memo.as_mut();
        memo.downcast_mut().expect("a memo is that of the body that made it")
    }
}

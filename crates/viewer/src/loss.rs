//! The news that the device was lost, carried from the device's callback to the page.
//!
//! The callback must be `Send`, which nothing on a page is. So the callback only leaves the reason and wakes
//! a task of the page, which then calls what it likes, outside of any call of the device.

use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll, Waker};

/// A loss that may come: a future of the reason.
#[derive(Debug, Default)]
pub(crate) struct Loss(Arc<Mutex<Letter>>);

/// Tells of the loss.
#[derive(Debug)]
pub(crate) struct Teller(Arc<Mutex<Letter>>);

#[derive(Debug, Default)]
struct Letter {
    reason: Option<String>,
    waker: Option<Waker>,
}

impl Loss {
    pub(crate) fn teller(&self) -> Teller {
        Teller(Arc::clone(&self.0))
    }
}

impl Teller {
    pub(crate) fn tell(&self, reason: String) {
        let mut letter = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        letter.reason = Some(reason);
        let waker = letter.waker.take();
        drop(letter);
        if let Some(waker) = waker {
            waker.wake();
        }
    }
}

impl Future for Loss {
    type Output = String;

    fn poll(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<String> {
        let mut letter = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(reason) = letter.reason.take() {
            return Poll::Ready(reason);
        }
        letter.waker = Some(context.waker().clone());
        Poll::Pending
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn news_arrive_whenever_they_are_told() {
        let mut context = Context::from_waker(Waker::noop());
        let mut loss = Loss::default();
        assert!(Pin::new(&mut loss).poll(&mut context).is_pending());
        loss.teller().tell("gone".to_owned());
        assert_eq!(Pin::new(&mut loss).poll(&mut context), Poll::Ready("gone".to_owned()));
    }
}

//! Closed-form solutions that models are verified against, one family a file.

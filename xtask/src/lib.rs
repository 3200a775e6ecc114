//! Every job of the project, one file a verb; what verbs share stands beside them.

pub mod ci;
pub mod demo;
pub mod evaluate;
pub mod kinematics;
pub mod library;
pub mod models;
pub mod pose;
pub mod serve;
pub mod synthetic;
pub mod test;

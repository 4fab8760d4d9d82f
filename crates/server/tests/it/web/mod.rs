//! Tests of the server as a process, over HTTP.

mod again;
mod answers;
mod backup;
mod collisions;
mod crashes;
mod deadline;
mod description;
mod example;
mod flows;
mod hidden;
mod hostile;
mod limits;
mod messages;
mod metrics;
mod ownership;
mod people;
mod platforms;
mod providers;
mod removal;
mod roles;
mod settings;
mod signs;
mod storage;
mod teaching;
mod upgrade;
mod workers;

/// A GPU as it is named to users.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Adapter {
    /// The name that the driver gives it.
    pub name: String,
    /// The interface through which it is used, such as Vulkan.
    pub interface: String,
    /// Whether it is a software GPU on the CPU: correct, but slow.
    pub is_software: bool,
}

impl std::fmt::Display for Adapter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { name, interface, is_software } = self;
        write!(f, "{name} ({interface}{})", if *is_software { ", in software" } else { "" })
    }
}

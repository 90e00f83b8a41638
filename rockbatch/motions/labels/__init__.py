"""Labels of components: direction, station and event by headers, channel codes and names."""

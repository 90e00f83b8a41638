"""What headers, channel codes and names say of a component: its direction, station and event."""

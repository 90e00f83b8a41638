"""Work of dampers and tendons."""

"""Settlement of springs that ratchet by the other spring law, the other end of its range."""

"""What a run came to, its histories, and what follows from them without the core."""

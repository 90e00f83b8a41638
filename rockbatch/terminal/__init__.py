"""What all commands share: the streams, messages and progress on the terminal, and arguments."""

"""Many runs: which, in which groups, by what they are carried out, and what is left of them on disk."""

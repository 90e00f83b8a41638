"""One module per subcommand: ``add_arguments(parser)`` and ``main(arguments) -> exit code``."""

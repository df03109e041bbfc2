"""The offline room: the command line, histories, plots and reports. No ROS graph is needed here."""

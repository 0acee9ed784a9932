"""Jobs: many regions of one building, each read, cut, fitted, built and proved by itself, and none of them twice.

A job file says which (`read`, made of the settings' own fields); every region becomes a task that holds all it depends
on, bytes and not paths, so that its result is a function of its content alone (`task`, `work`). Where tasks are worked
off, here or by many workers, is an engine's matter (`engine`); what is made is kept by content (`results`), put in its
place whole or not at all, and counted (`run`, `summary`).
"""

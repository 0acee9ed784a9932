"""What a page is made of: its frame, style and program, and the library that draws in three dimensions."""

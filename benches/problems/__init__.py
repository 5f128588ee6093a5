"""Cases of charts and maps: materials, scenes with parameters, and closed forms."""

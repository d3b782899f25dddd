"""People's own controls: buttons, sliders, lists, texts, plots, images and frames, with callbacks."""

"""All pages of the gallery, in their order."""

from scenes.lab.gallery import extremes, masks, motions, piles, sweeps

PAGES = (*sweeps.PAGES, *motions.PAGES, *piles.PAGES, *masks.PAGES, *extremes.PAGES)

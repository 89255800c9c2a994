// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   pqVoxplexLabelTableWidget
 * @brief   the property LabelTable in the panel: the labels of the image, to tick and to give sizes
 *
 * The rows come from the server (vtkPVLabelInformation): what the array LabelArray of the Input has when the panel is shown
 * and when its data changes. Of a time series, that is the present time; labels with a name are listed at all times.
 * The property has only the labels that differ from all others (pqVoxplexLabelModel::settings()).
 *
 * A change applies to all selected rows if the changed one is among them.
 */
#ifndef pqVoxplexLabelTableWidget_h
#define pqVoxplexLabelTableWidget_h

#include "pqPropertyWidget.h"

#include <QList>
#include <QVariant>

class QLabel;
class pqPipelineSource;
class pqTreeView;
class pqVoxplexLabelModel;

class pqVoxplexLabelTableWidget : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(QList<QVariant> settings READ settings WRITE setSettings NOTIFY settingsChanged)
  typedef pqPropertyWidget Superclass;

public:
  pqVoxplexLabelTableWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqVoxplexLabelTableWidget() override = default;

  ///@{
  /** The value of the property. */
  QList<QVariant> settings() const;
  void setSettings(const QList<QVariant>& values);
  ///@}

Q_SIGNALS:
  void settingsChanged();

protected:
  void showEvent(QShowEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

private Q_SLOTS:
  void onDataUpdated(pqPipelineSource* source);
  /** Asks the server for the labels; while the panel is hidden, later. */
  void gather();
  void showSummary();
  void fitColumns();

private:
  Q_DISABLE_COPY(pqVoxplexLabelTableWidget)

  pqVoxplexLabelModel* Model;
  pqTreeView* View;
  QLabel* Summary;
  QString Problem; ///< why there are no labels
  bool IsStale = true;
};

#endif
